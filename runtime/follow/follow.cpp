// SPDX-License-Identifier: MIT
#include "hairloom/follow.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "engine/in_parallel.h"
#include "engine/state.h"
#include "follow/follow_kernels.h"

namespace hairloom::runtime {
namespace {

constexpr std::size_t kGuidesPerJob = 64;
constexpr std::size_t kHairsPerJob = 512;
constexpr std::uint32_t kMaxHairPoints = 1u << 20u;  // kernels count the floats of 16 guides in 32 bits
constexpr float kWeightSumTolerance = 1e-3f;

struct Expectation {
    const char* name;
    std::size_t size;
    std::size_t expected;
};

std::string sizeError(const FollowView& view) {
    const std::size_t guides = view.guideOffsets.size() - 1;
    const std::size_t hairs = view.guides.size();
    const Expectation expectations[] = {
        {"root planes", view.rootPlanes_ss.size(), guides},
        {"radii", view.radii.size(), view.pointsPerHair},
        {"weights", view.weights.size(), hairs},
        {"root weights", view.rootWeights.size(), hairs},
        {"wisp offsets", view.wispOffsets.size(), hairs},
        {"blends", view.blends.size(), hairs},
        {"root shifts", view.rootShifts.size(), hairs},
    };
    for (const Expectation& e : expectations) {
        if (e.size != e.expected)
            return std::to_string(e.size) + " " + e.name + "; expected " + std::to_string(e.expected);
    }
    return {};
}

std::string guideError(const FollowView& view) {
    if (view.guideOffsets.size() < 2 || view.guideOffsets.front() != 0) {
        return "no guide offsets from 0; expected guide count + 1 of them";
    }
    if (view.pointsPerHair < 2 || view.pointsPerHair > kMaxHairPoints) {
        return std::to_string(view.pointsPerHair) + " points per hair; expected 2 to " +
               std::to_string(kMaxHairPoints);
    }
    bool resampled = false;
    for (std::size_t g = 0; g + 1 < view.guideOffsets.size(); ++g) {
        const std::uint32_t first = view.guideOffsets[g], end = view.guideOffsets[g + 1];
        if (end < first || end - first < 2) {
            return "guide " + std::to_string(g) + " runs from point " + std::to_string(first) + " to " +
                   std::to_string(end) + "; expected two points or more";
        }
        resampled = resampled || end - first != view.pointsPerHair;
    }
    const std::size_t points = view.guideOffsets.back();
    const std::size_t rests = view.guideRestPositions_ss.size();
    if (rests != points && (resampled || rests != 0)) {
        return std::to_string(rests) + " rest positions of guides; expected " + std::to_string(points);
    }
    for (std::size_t p = 0; p < rests; ++p) {
        if (!isFinite(view.guideRestPositions_ss[p]))
            return "rest position " + std::to_string(p) + " is not finite";
    }
    return {};
}

bool isShare(float value) {
    return value >= 0.0f && value <= 1.0f;
}

bool isPartition(Float3 w) {
    return isShare(w.x) && isShare(w.y) && isShare(w.z) &&
           std::abs(w.x + w.y + w.z - 1.0f) <= kWeightSumTolerance;
}

std::string hairError(const FollowView& view, std::size_t hair) {
    const auto guides = static_cast<std::uint32_t>(view.guideOffsets.size() - 1);
    for (const std::uint32_t guide : view.guides[hair]) {
        if (guide >= guides)
            return "follows guide " + std::to_string(guide) + " of " + std::to_string(guides);
    }
    if (!isPartition(view.weights[hair])) return "has weights that are not shares of 1";
    if (!isPartition(view.rootWeights[hair])) return "has root weights that are not shares of 1";
    if (!isShare(view.blends[hair])) return "has a blend that is not between 0 and 1";
    const auto& offset = view.wispOffsets[hair];
    if (!std::isfinite(offset[0]) || !std::isfinite(offset[1])) return "has a wisp offset that is not finite";
    if (!isFinite(view.rootShifts[hair])) return "has a root shift that is not finite";
    return {};
}

std::string validationError(const FollowView& view) {
    if (std::string why = guideError(view); !why.empty()) return why;
    if (std::string why = sizeError(view); !why.empty()) return why;
    for (std::size_t g = 0; g < view.rootPlanes_ss.size(); ++g) {
        const RootPlane& plane = view.rootPlanes_ss[g];
        if (!isFinite(plane.x) || !isFinite(plane.y) || !isFinite(plane.normal)) {
            return "the root plane of guide " + std::to_string(g) + " is not finite";
        }
    }
    for (std::size_t p = 0; p < view.radii.size(); ++p) {
        if (!(view.radii[p] >= 0.0f) || !std::isfinite(view.radii[p])) {
            return "the wisp radius at point " + std::to_string(p) + " is not a length";
        }
    }
    const WispMotion& wisps = view.wisps;
    if (!(wisps.spread >= 0.0f && wisps.spread <= kMostSpread))
        return "wisps widen by " + std::to_string(wisps.spread) + " per m/s; expected 0 to 10";
    if (!(wisps.limit >= 1.0f && wisps.limit <= kMostWidening))
        return "wisps widen at most " + std::to_string(wisps.limit) + " times; expected 1 to 100";
    for (std::size_t hair = 0; hair < view.guides.size(); ++hair) {
        if (std::string why = hairError(view, hair); !why.empty())
            return "hair " + std::to_string(hair) + " " + why;
    }
    return {};
}

std::size_t rowFloatsOf(std::uint32_t points) {
    return (std::size_t{points} * 3 + kRowFloats - 1) / kRowFloats * kRowFloats;
}

HairBinding packHair(const FollowView& view, std::size_t hair) {
    const float blend = view.blends[hair];
    const Float3 weights = view.weights[hair] * blend;
    const Float3 moved = (view.rootWeights[hair] - view.weights[hair]) * blend;
    const Float3 shift = view.rootShifts[hair];
    HairBinding packed{};
    packed.guides = view.guides[hair];
    packed.single = 1.0f - blend;
    packed.wispOffset = {packed.single * view.wispOffsets[hair][0],
                         packed.single * view.wispOffsets[hair][1]};
    packed.weights = {weights.x, weights.y, weights.z};
    packed.rootWeights = {moved.x, moved.y, moved.z};
    packed.rootShift = {shift.x, shift.y, shift.z};
    for (std::size_t k = 1; k < 3; ++k) {
        // What is no number would show even through a weight of 0.
        if (packed.weights[k] == 0.0f && packed.rootWeights[k] == 0.0f) packed.guides[k] = packed.guides[0];
    }
    return packed;
}

/// Both ends exactly, and a share of 0 or 1 leaves out the point that it takes nothing of.
Float3 between(const Float3* points, GuideSample sample) {
    const Float3 from = points[sample.segment], to = points[sample.segment + 1];
    if (sample.share == 0.0f) return from;
    if (sample.share == 1.0f) return to;
    return from + (to - from) * sample.share;
}

void storePlane(const RootPlane& plane, Quat turn, float* frame) {
    if (!normalize(turn)) turn = {};
    const Float3 axes[] = {rotate(turn, plane.x), rotate(turn, plane.y), rotate(turn, plane.normal)};
    for (std::size_t axis = 0; axis < 3; ++axis) std::memcpy(frame + 4 * axis, &axes[axis], sizeof(Float3));
}

/// As evaluateSome() takes them.
bool areGroups(std::span<const std::uint32_t> groups, std::span<const std::uint32_t> taken,
               std::size_t hairs) {
    if (groups.empty() || groups.size() != taken.size() || groups.front() != 0 || taken.front() != 0 ||
        groups.back() != hairs)
        return false;
    for (std::size_t g = 0; g + 1 < groups.size(); ++g) {
        if (groups[g] > groups[g + 1] || taken[g] > taken[g + 1] ||
            taken[g + 1] - taken[g] > groups[g + 1] - groups[g])
            return false;
    }
    return true;
}

/// Calls body(hair, first, count) for runs of hairs that follow each other: `hair` of all, `first` of those
/// that are taken.
template <class Body>
void forTaken(const Host& host, std::span<const std::uint32_t> groups, std::span<const std::uint32_t> taken,
              const Body& body) {
    if (taken.back() == groups.back()) {
        inParallel(host, groups.back(), kHairsPerJob,
                   [&](std::size_t begin, std::size_t end) { body(begin, begin, end - begin); });
        return;
    }
    inParallel(host, groups.size() - 1, kGuidesPerJob, [&](std::size_t begin, std::size_t end) {
        for (std::size_t g = begin; g < end; ++g) body(groups[g], taken[g], taken[g + 1] - taken[g]);
    });
}

}  // namespace

void sampleEvenly(std::span<const Float3> guide, std::uint32_t count, Vector<GuideSample>& samples) {
    Vector<double> arc(guide.size(), 0.0);
    for (std::size_t p = 1; p < guide.size(); ++p) {
        const Float3 step = guide[p] - guide[p - 1];
        arc[p] = arc[p - 1] + std::hypot(double{step.x}, double{step.y}, double{step.z});
    }
    std::size_t segment = 0;
    for (std::uint32_t i = 0; i + 1 < count; ++i) {
        const double target = arc.back() * i / (count - 1);
        while (segment + 2 < guide.size() && arc[segment + 1] < target) ++segment;
        const double length = arc[segment + 1] - arc[segment];
        const double share = length > 0.0 ? std::clamp((target - arc[segment]) / length, 0.0, 1.0) : 0.0;
        samples.push_back({static_cast<std::uint32_t>(segment), static_cast<float>(share)});
    }
    samples.push_back({static_cast<std::uint32_t>(guide.size() - 2), 1.0f});
}

struct FollowHairs::Impl : InMemory {
    std::uint32_t points = 0;
    std::size_t rowFloats = 0;
    Vector<std::uint32_t> guideOffsets;
    Vector<RootPlane> rootPlanes;
    Vector<std::size_t> firstSample;  // per guide; kNoSamples where its points are taken as they are
    Vector<GuideSample> samples;      // `points` of them for each guide that is resampled
    Vector<float> radii;
    WispMotion wispMotion;
    Vector<HairBinding> hairs;
    Floats positions, wisps, frames;  // of the frame, as GuideRows has them

    static constexpr std::size_t kNoSamples = static_cast<std::size_t>(-1);

    explicit Impl(const FollowView& view);
    std::size_t guideCount() const { return rootPlanes.size(); }
    /// A quantity of the guide's points as a row of points per hair.
    void fillRow(std::size_t guide, std::span<const Float3> values, float* row) const;
    void fillGuides(const GuideMotion& motion, const GuideRows& rows, std::size_t begin, std::size_t end);
    /// Whether sizes fit.
    bool takes(const GuideMotion& guides, std::span<const std::uint32_t> groups,
               std::span<const std::uint32_t> taken) const;
    GuideRows placeGuides(const GuideMotion& guides, const Host& host);
    void sum(const GuideRows& rows, std::size_t first, std::size_t count, Float3* to) const;
};

FollowHairs::Impl::Impl(const FollowView& view)
    : points(view.pointsPerHair),
      rowFloats(rowFloatsOf(points)),
      guideOffsets(view.guideOffsets.begin(), view.guideOffsets.end()),
      rootPlanes(view.rootPlanes_ss.begin(), view.rootPlanes_ss.end()),
      firstSample(view.rootPlanes_ss.size(), kNoSamples),
      radii(view.radii.begin(), view.radii.end()),
      wispMotion(view.wisps) {
    for (std::size_t g = 0; g < guideCount(); ++g) {
        const std::uint32_t count = guideOffsets[g + 1] - guideOffsets[g];
        if (count == points) continue;
        firstSample[g] = samples.size();
        sampleEvenly(view.guideRestPositions_ss.subspan(guideOffsets[g], count), points, samples);
    }
    hairs.reserve(view.guides.size());
    for (std::size_t hair = 0; hair < view.guides.size(); ++hair) hairs.push_back(packHair(view, hair));
    positions.assign(guideCount() * rowFloats, 0.0f);
    wisps.assign(guideCount() * rowFloats * kWispRows, 0.0f);
    frames.assign(guideCount() * kFrameFloats, 0.0f);
}

void FollowHairs::Impl::fillRow(std::size_t guide, std::span<const Float3> values, float* row) const {
    const Float3* first = values.data() + guideOffsets[guide];
    if (firstSample[guide] == kNoSamples) {
        std::memcpy(row, first, points * sizeof(Float3));
        return;
    }
    const GuideSample* sample = samples.data() + firstSample[guide];
    for (std::uint32_t i = 0; i < points; ++i) {
        const Float3 value = between(first, sample[i]);
        std::memcpy(row + std::size_t{i} * 3, &value, sizeof(Float3));
    }
}

void FollowHairs::Impl::fillGuides(const GuideMotion& motion, const GuideRows& rows, std::size_t begin,
                                   std::size_t end) {
    for (std::size_t g = begin; g < end; ++g) {
        fillRow(g, motion.positions_ws, positions.data() + g * rowFloats);
        float* velocities = wisps.data() + g * rowFloats * kWispRows;
        if (motion.velocities_ws.empty()) {
            std::fill_n(velocities, rowFloats, 0.0f);
        } else {
            fillRow(g, motion.velocities_ws, velocities);
        }
        const Quat turn = motion.rootRotations_ws.empty() ? Quat{} : motion.rootRotations_ws[g];
        storePlane(rootPlanes[g], turn, frames.data() + g * kFrameFloats);
    }
    followKernels().fillWisps(rows, begin, end);
}

bool FollowHairs::Impl::takes(const GuideMotion& guides, std::span<const std::uint32_t> groups,
                              std::span<const std::uint32_t> taken) const {
    const auto fits = [](std::size_t size, std::size_t wanted) { return size == 0 || size == wanted; };
    return areGroups(groups, taken, hairs.size()) && guides.positions_ws.size() == guideOffsets.back() &&
           fits(guides.velocities_ws.size(), guides.positions_ws.size()) &&
           fits(guides.rootRotations_ws.size(), guideCount());
}

GuideRows FollowHairs::Impl::placeGuides(const GuideMotion& guides, const Host& host) {
    const GuideRows rows{points,           rowFloats,    radii.data(), wispMotion,
                         positions.data(), wisps.data(), frames.data()};
    inParallel(host, guideCount(), kGuidesPerJob,
               [&](std::size_t begin, std::size_t end) { fillGuides(guides, rows, begin, end); });
    return rows;
}

void FollowHairs::Impl::sum(const GuideRows& rows, std::size_t first, std::size_t count, Float3* to) const {
    static_assert(sizeof(Float3) == 3 * sizeof(float));
    followKernels().sumRows(rows, std::span<const HairBinding>(hairs).subspan(first, count),
                            reinterpret_cast<float*>(to));
}

FollowHairs::FollowHairs(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
FollowHairs::FollowHairs(const FollowHairs& other) : impl_(std::make_unique<Impl>(*other.impl_)) {}
FollowHairs::FollowHairs(FollowHairs&&) noexcept = default;
FollowHairs& FollowHairs::operator=(FollowHairs&&) noexcept = default;
FollowHairs::~FollowHairs() = default;

FollowHairs::Result FollowHairs::make(const FollowView& view) {
    if (std::string why = validationError(view); !why.empty()) return {std::nullopt, std::move(why)};
    return {FollowHairs(std::make_unique<Impl>(view)), {}};
}

std::uint32_t FollowHairs::hairCount() const {
    return static_cast<std::uint32_t>(impl_->hairs.size());
}
std::uint32_t FollowHairs::pointsPerHair() const {
    return impl_->points;
}

std::size_t FollowHairs::bytes() const {
    const Impl& impl = *impl_;
    return impl.hairs.size() * sizeof(HairBinding) + impl.rootPlanes.size() * sizeof(RootPlane) +
           impl.guideOffsets.size() * sizeof(std::uint32_t) + impl.firstSample.size() * sizeof(std::size_t) +
           impl.samples.size() * sizeof(GuideSample) +
           (impl.radii.size() + impl.positions.size() + impl.wisps.size() + impl.frames.size()) *
               sizeof(float);
}

std::size_t FollowHairs::bytesFor(std::size_t guides, std::size_t hairs, std::uint32_t pointsPerHair) {
    const std::size_t rows = rowFloatsOf(pointsPerHair) * (1 + kWispRows) + kFrameFloats;
    return hairs * sizeof(HairBinding) + pointsPerHair * sizeof(float) + sizeof(std::uint32_t) +
           guides * (rows * sizeof(float) + sizeof(RootPlane) + sizeof(std::uint32_t) + sizeof(std::size_t) +
                     pointsPerHair * sizeof(GuideSample));
}

bool FollowHairs::evaluate(const GuideMotion& guides, std::span<Float3> hairs_ws, const Host& host) {
    const std::uint32_t all[] = {0, hairCount()};
    return evaluateSome(guides, all, all, hairs_ws, host);
}

bool FollowHairs::evaluateSome(const GuideMotion& guides, std::span<const std::uint32_t> groups,
                               std::span<const std::uint32_t> taken, std::span<Float3> hairs_ws,
                               const Host& host) {
    if (!impl_->takes(guides, groups, taken) || hairs_ws.size() != std::size_t{taken.back()} * impl_->points)
        return false;
    const GuideRows rows = impl_->placeGuides(guides, host);
    forTaken(host, groups, taken, [&](std::size_t hair, std::size_t first, std::size_t count) {
        impl_->sum(rows, hair, count, hairs_ws.data() + first * impl_->points);
    });
    return true;
}

bool FollowHairs::showSome(const GuideMotion& guides, std::span<const std::uint32_t> groups,
                           std::span<const std::uint32_t> taken, Float3* hairs_ws, const Sink& sink,
                           const Host& host) {
    const std::size_t points = impl_->points;
    if (points > kMaxShownPoints || !impl_->takes(guides, groups, taken)) return false;
    const GuideRows rows = impl_->placeGuides(guides, host);
    const std::size_t most = kMaxShownPoints / points;
    forTaken(host, groups, taken, [&](std::size_t hair, std::size_t first, std::size_t count) {
        std::array<Float3, kMaxShownPoints> here;
        for (std::size_t done = 0; done < count; done += most) {
            const std::size_t some = std::min(most, count - done);
            Float3* const to = hairs_ws ? hairs_ws + (first + done) * points : here.data();
            impl_->sum(rows, hair + done, some, to);
            if (sink) sink(first + done, some, to);
        }
    });
    return true;
}

}  // namespace hairloom::runtime
