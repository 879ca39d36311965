// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/live/drawn_depth.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/animation/root_motion.h"
#include "core/base/parallel.h"
#include "core/geometry/mesh_solid.h"
#include "core/interpolation/strand_follow.h"
#include "core/simulation/body_push.h"

namespace hairloom {
namespace {

constexpr float kStep = 0.002f;       ///< metres between places along a hair at rest, at most
constexpr float kRootPart = 0.005f;   ///< metres from the root that do not count
constexpr float kTouching = 1e-5f;    ///< metres: rounding of positions a metre from the origin, and less
constexpr std::uint32_t kMost = 256;  ///< places in a segment
constexpr std::size_t kGrain = 32;    ///< strands

/// A body in one pose.
struct PosedBody {
    PosedBody(std::span<const Vec3f> positions, std::span<const Triangle> triangles)
        : solid(positions, triangles), grid(solid) {}
    MeshSolid solid;
    SolidGrid grid;
};

/// The curve that is drawn through the points of a strand, beyond whose ends it goes on as a mirror image.
struct DrawnCurve {
    std::span<const Vec3f> points;

    /// Neighbours of a segment's ends.
    Vec3f before(std::size_t segment) const {
        return segment > 0 ? points[segment - 1] : Vec3f(2 * points[0] - points[1]);
    }
    Vec3f after(std::size_t segment) const {
        return segment + 2 < points.size() ? points[segment + 2]
                                           : Vec3f(2 * points[segment + 1] - points[segment]);
    }
    Vec3f at(std::size_t segment, float t) const {
        const Vec3f &p1 = points[segment], &p2 = points[segment + 1];
        const Vec3f p0 = before(segment), p3 = after(segment);
        const Vec3f a = p2 - p0, b = 2 * p0 - 5 * p1 + 4 * p2 - p3, c = p3 - p0 + 3 * (p1 - p2);
        return p1 + 0.5f * t * (a + t * (b + t * c));
    }
    /// Metres from the first of a segment's ends within which the whole segment lies: its Bézier points do.
    float reach(std::size_t segment) const {
        const Vec3f &p1 = points[segment], &p2 = points[segment + 1];
        const float out = (p2 - before(segment)).norm() / 6;
        return std::max(out, (p2 - p1).norm() + (after(segment) - p1).norm() / 6);
    }
};

/// What is known of the distance at places along one strand, in order.
class Walk {
  public:
    explicit Walk(const PosedBody& body) : body_(body) {}

    /// Depth there, 0 outside. Where it surely lies between `enough` and `most`, any number between them may
    /// come back; where it is surely not above `enough`, 0 may.
    float depth(const Vec3f& p, float enough, float most) {
        const SolidGrid::Bound bound = body_.grid.at(p);
        if (std::isinf(bound.distance))
            return remember(p, body_.solid.bounds().exteriorDistance(p), false, 0);
        const float least = std::abs(bound.distance) - bound.away;
        if (least > kTouching && bound.distance > 0) return remember(p, least, false, 0);
        if (least > kTouching) {
            if (bound.away - bound.distance <= enough) return remember(p, least, true, 0);
            if (least > enough && bound.away - bound.distance <= most) return remember(p, least, true, least);
        }
        if (known_) {
            // No surface is nearer to the last place than its distance.
            const float gap = (p - last_).norm() + kTouching;
            if (gap < distance_ && !inside_) return 0;
            if (gap < distance_ && distance_ - gap > enough && distance_ + gap <= most)
                return distance_ - gap;
        }
        const float distance = body_.solid.distance(p);
        // No surface lies between two places whose distances reach each other.
        const bool same = known_ && (p - last_).norm() < 0.999f * (distance + distance_);
        inside_ = same ? inside_ : body_.solid.contains(p);
        return remember(p, distance, inside_, inside_ ? distance : 0);
    }

    /// Whether there is surely nothing of the body within `reach` of a place outside of it.
    bool isFree(const Vec3f& p, float reach) {
        const SolidGrid::Bound bound = body_.grid.at(p);
        const float around = std::isinf(bound.distance) ? body_.solid.bounds().exteriorDistance(p)
                                                        : bound.distance - bound.away;
        if (!(around > reach + kTouching)) return false;
        remember(p, around, false, 0);
        return true;
    }

  private:
    /// That no surface is nearer to a place than `distance`; gives back `depth`.
    float remember(const Vec3f& p, float distance, bool inside, float depth) {
        known_ = true;
        last_ = p;
        distance_ = distance;
        inside_ = inside;
        return depth;
    }

    const PosedBody& body_;
    bool known_ = false, inside_ = false;
    Vec3f last_ = Vec3f::Zero();
    float distance_ = 0;
};

/// The deepest place of a strand, and how many of its places are inside.
struct StrandDepth {
    float deepest = 0;
    std::uint32_t inside = 0;
};

/// Strands with the places where they are looked at, which the shape at rest decides.
class Curves {
  public:
    Curves(std::vector<std::uint32_t> offsets, std::span<const Vec3f> rest, const PosedBody& body)
        : offsets_(std::move(offsets)) {
        const std::size_t segments = rest.size();
        places_.assign(segments, 0);
        skipped_.assign(segments, 0);
        depths_.resize(count());
        for (std::size_t s = 0; s < count(); ++s) choosePlaces(s, rest);
        measureAuthored(rest, body);
    }

    std::size_t count() const { return offsets_.empty() ? 0 : offsets_.size() - 1; }
    std::uint64_t placeCount() const { return placeCount_; }
    float authored() const { return authored_; }

    /// Of points that lie in the body's space after `toBody`. Depths up to `known` are not told apart.
    StrandDepth measure(std::span<const Vec3f> points, const Eigen::Isometry3f& toBody, const PosedBody& body,
                        double known) {
        known_ = static_cast<float>(known);
        parallelFor(count(), kGrain, [&](std::size_t begin, std::size_t end) {
            std::vector<Vec3f> moved;
            for (std::size_t s = begin; s < end; ++s)
                depths_[s] = strandDepth(s, points, toBody, body, moved);
        });
        return sum();
    }
    std::uint64_t insideCount() const { return inside_; }

  private:
    void choosePlaces(std::size_t s, std::span<const Vec3f> rest) {
        float along = 0;
        for (std::uint32_t p = offsets_[s]; p + 1 < offsets_[s + 1]; ++p) {
            const float length = (rest[p + 1] - rest[p]).norm();
            const float wanted = std::ceil(length / kStep);
            places_[p] = static_cast<std::uint16_t>(
                std::clamp(std::isfinite(wanted) ? wanted : 1.0f, 1.0f, static_cast<float>(kMost)));
            const float step = length / static_cast<float>(places_[p]);
            const float left = step > 0 ? std::floor((kRootPart - along) / step) : 0;
            skipped_[p] = static_cast<std::uint16_t>(std::clamp(left, 0.0f, static_cast<float>(places_[p])));
            along += length;
            placeCount_ += std::uint64_t{places_[p]} - skipped_[p];
        }
    }

    /// Calls visit(segment, share of it, number of the place) for each place that counts and may be inside.
    template <class Visit>
    void forEachPlace(std::size_t s, const DrawnCurve& curve, Walk& walk, Visit&& visit) const {
        std::size_t number = 0;
        for (std::uint32_t p = offsets_[s]; p + 1 < offsets_[s + 1]; ++p) {
            const std::size_t segment = p - offsets_[s];
            if (walk.isFree(curve.points[segment], curve.reach(segment))) {
                number += std::size_t{places_[p]} - skipped_[p];
                continue;
            }
            for (std::uint32_t i = skipped_[p]; i < places_[p]; ++i)
                visit(segment, static_cast<float>(i + 1) / static_cast<float>(places_[p]), number++);
        }
    }
    std::size_t placesOf(std::size_t s) const {
        std::size_t count = 0;
        for (std::uint32_t p = offsets_[s]; p + 1 < offsets_[s + 1]; ++p)
            count += std::size_t{places_[p]} - skipped_[p];
        return count;
    }

    void measureAuthored(std::span<const Vec3f> rest, const PosedBody& body) {
        std::vector<std::vector<float>> depths(count());
        parallelFor(count(), kGrain, [&](std::size_t begin, std::size_t end) {
            for (std::size_t s = begin; s < end; ++s) {
                const DrawnCurve curve{rest.subspan(offsets_[s], offsets_[s + 1] - offsets_[s])};
                Walk walk(body);
                std::vector<float> own(placesOf(s), 0.0f);
                bool any = false;
                forEachPlace(s, curve, walk, [&](std::size_t segment, float t, std::size_t number) {
                    own[number] = walk.depth(curve.at(segment, t), 0, 0);
                    any |= own[number] > 0;
                });
                if (any) depths[s] = std::move(own);
            }
        });
        allowedFrom_.push_back(0);
        for (const auto& own : depths) {
            allowed_.insert(allowed_.end(), own.begin(), own.end());
            allowedFrom_.push_back(allowed_.size());
        }
        for (const float depth : allowed_) authored_ = std::max(authored_, depth);
    }

    StrandDepth strandDepth(std::size_t s, std::span<const Vec3f> points, const Eigen::Isometry3f& toBody,
                            const PosedBody& body, std::vector<Vec3f>& moved) const {
        moved.clear();
        for (const Vec3f& point : points.subspan(offsets_[s], offsets_[s + 1] - offsets_[s])) {
            if (!point.allFinite()) return {};
            moved.push_back(toBody * point);
        }
        const DrawnCurve curve{moved};
        const std::span<const float> allowed(allowed_.data() + allowedFrom_[s],
                                             allowedFrom_[s + 1] - allowedFrom_[s]);
        StrandDepth result;
        Walk walk(body);
        forEachPlace(s, curve, walk, [&](std::size_t segment, float t, std::size_t number) {
            const float own = (allowed.empty() ? 0 : allowed[number]) + kTouching;
            const float depth = walk.depth(curve.at(segment, t), own, own + std::max(result.deepest, known_));
            if (!(depth > own)) return;
            ++result.inside;
            result.deepest = std::max(result.deepest, depth - own);
        });
        return result;
    }

    StrandDepth sum() {
        StrandDepth total;
        for (const StrandDepth& depth : depths_) {
            total.deepest = std::max(total.deepest, depth.deepest);
            inside_ += depth.inside;
        }
        return total;
    }

    std::vector<std::uint32_t> offsets_;
    std::vector<std::uint16_t> places_,
        skipped_;  ///< of the segment from each point on; the last before tips has none
    std::uint64_t placeCount_ = 0, inside_ = 0;
    std::vector<std::size_t> allowedFrom_;  ///< of each strand; one past the end last
    std::vector<float> allowed_;            ///< authored depth of each place, of strands that have any
    float authored_ = 0, known_ = 0;
    std::vector<StrandDepth> depths_;
};

std::span<const runtime::Float3> asEngine(std::span<const Vec3f> values) {
    static_assert(sizeof(Vec3f) == sizeof(runtime::Float3));
    return {reinterpret_cast<const runtime::Float3*>(values.data()), values.size()};
}

/// The hairs between guides, frame after frame.
class DrawnFollowHairs {
  public:
    static Result<DrawnFollowHairs> make(const Groom& groom) {
        const auto bindings = bindFollowHairs(groom, groom.interpolation);
        if (!bindings) return tl::unexpected(bindings.error());
        const StrandFollow follow(groom, *bindings);
        auto made = runtime::FollowHairs::make(follow.view());
        if (!made.hairs) return tl::unexpected(errorOfWords(made.error));
        return DrawnFollowHairs(std::move(*made.hairs));
    }

    std::vector<std::uint32_t> offsets() const {
        std::vector<std::uint32_t> offsets(hairs_.hairCount() + 1);
        for (std::size_t h = 0; h < offsets.size(); ++h)
            offsets[h] = static_cast<std::uint32_t>(h * hairs_.pointsPerHair());
        return offsets;
    }

    std::span<const Vec3f> at(std::span<const Vec3f> positions_ws, std::span<const Vec3f> velocities_ws,
                              std::span<const Quatf> rotations) {
        static_assert(sizeof(Quatf) == sizeof(runtime::Quat));
        runtime::GuideMotion guides;
        guides.positions_ws = asEngine(positions_ws);
        guides.velocities_ws = asEngine(velocities_ws);
        guides.rootRotations_ws = {reinterpret_cast<const runtime::Quat*>(rotations.data()),
                                   rotations.size()};
        runtime::Host host;
        host.parallelFor = parallelFor;
        hairs_.evaluate(guides, {reinterpret_cast<runtime::Float3*>(points_.data()), points_.size()}, host);
        return points_;
    }

  private:
    explicit DrawnFollowHairs(runtime::FollowHairs hairs)
        : hairs_(std::move(hairs)),
          points_(std::size_t{hairs_.hairCount()} * hairs_.pointsPerHair(), Vec3f::Zero()) {}

    runtime::FollowHairs hairs_;
    std::vector<Vec3f> points_;
};

}  // namespace

struct DrawnDepthMeter::Impl {
    std::shared_ptr<const ScalpMesh> scalp;
    std::vector<SurfacePoint> roots;
    std::size_t strands;
    PosedBody rest;
    std::optional<Curves> guides;
    std::optional<DrawnFollowHairs> follow;
    std::optional<Curves> hairs;  ///< of `follow`, or of guides that a body pushes out
    std::shared_ptr<const Groom> whole;
    std::optional<runtime::BodyPush> push;
    std::vector<Vec3f> drawnPoints;
    std::uint64_t frames = 0;
    DrawnDepth result;

    explicit Impl(const Groom& groom)
        : scalp(groom.scalp),
          roots(groom.rootBindings()),
          strands(groom.strandCount()),
          rest(scalp->positions(), scalp->triangles()) {}

    std::vector<Quatf> rotationsAt(const HeadPose& pose) const {
        if (roots.empty() || pose.scalpPositions_ws.empty())
            return std::vector<Quatf>(strands, Quatf(pose.head_ws.linear()));
        std::vector<Quatf> rotations;
        for (const auto& transform : rootTransforms(*scalp, pose.scalpPositions_ws, roots))
            rotations.emplace_back(transform.linear());
        return rotations;
    }

    void add(std::uint64_t frame, std::span<const Vec3f> positions_ws, std::span<const Vec3f> velocities_ws,
             const HeadPose& pose) {
        std::optional<PosedBody> moved;
        Eigen::Isometry3f toBody = pose.head_ws.inverse();
        if (!pose.scalpPositions_ws.empty()) {
            moved.emplace(pose.scalpPositions_ws, scalp->triangles());
            toBody.setIdentity();
        }
        const PosedBody& body = moved ? *moved : rest;
        const float guide = guides->measure(positions_ws, toBody, body, result.deepestGuide).deepest;
        result.deepestGuide = std::max(result.deepestGuide, static_cast<double>(guide));
        float drawn = guide;
        if (hairs) {
            std::span<const Vec3f> points = positions_ws;
            if (follow) points = follow->at(positions_ws, velocities_ws, rotationsAt(pose));
            drawnPoints.assign(points.begin(), points.end());
            if (push) pushOutOfBody(*push, *whole, pose, drawnPoints);
            drawn = hairs->measure(drawnPoints, toBody, body, result.deepest).deepest;
        }
        ++frames;
        if (static_cast<double>(drawn) <= result.deepest) return;
        result.deepest = static_cast<double>(drawn);
        result.deepestFrame = frame;
    }
};

Result<DrawnDepthMeter> DrawnDepthMeter::make(const Groom& groom) {
    if (!groom.scalp)
        return fail("there is no head to measure depth in",
                    "expected a head, which `create` and `import --mesh` set");
    auto impl = std::make_unique<Impl>(groom);
    if (!impl->rest.solid.enclosesAnything())
        return fail("the head encloses no space in which hair could be",
                    "expected a mesh with an inside; it may be open at the neck");
    const auto offsets = groom.offsets.view();
    impl->guides.emplace(std::vector<std::uint32_t>(offsets.begin(), offsets.end()), groom.positions(),
                         impl->rest);
    if (groom.interpolation.followPerGuide > 0) {
        auto follow = DrawnFollowHairs::make(groom);
        if (!follow) return tl::unexpected(follow.error());
        impl->follow.emplace(std::move(*follow));
        const auto points = impl->follow->at(groom.positions(), {}, {});
        impl->hairs.emplace(impl->follow->offsets(), points, impl->rest);
        impl->push = makeBodyPush(groom, impl->follow->offsets(), points);
    } else if (groom.body) {
        impl->hairs.emplace(std::vector<std::uint32_t>(offsets.begin(), offsets.end()), groom.positions(),
                            impl->rest);
        impl->push = makeBodyPush(groom, offsets, groom.positions());
    }
    if (impl->push) impl->whole = std::make_shared<const Groom>(groom);
    return DrawnDepthMeter(std::move(impl));
}

DrawnDepthMeter::DrawnDepthMeter(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
DrawnDepthMeter::DrawnDepthMeter(DrawnDepthMeter&&) noexcept = default;
DrawnDepthMeter& DrawnDepthMeter::operator=(DrawnDepthMeter&&) noexcept = default;
DrawnDepthMeter::~DrawnDepthMeter() = default;

void DrawnDepthMeter::add(std::uint64_t frame, std::span<const Vec3f> positions_ws,
                          std::span<const Vec3f> velocities_ws, const HeadPose& pose) {
    impl_->add(frame, positions_ws, velocities_ws, pose);
}

DrawnDepth DrawnDepthMeter::result() const {
    const Curves& drawn = impl_->hairs ? *impl_->hairs : *impl_->guides;
    DrawnDepth result = impl_->result;
    result.authored = static_cast<double>(drawn.authored());
    const double places = static_cast<double>(drawn.placeCount() * impl_->frames);
    if (places > 0) result.shareInside = static_cast<double>(drawn.insideCount()) / places;
    return result;
}

}  // namespace hairloom
