// SPDX-License-Identifier: MIT
#include "models/rods/rod_poses.h"

#include <algorithm>
#include <cmath>

#include "engine/in_parallel.h"
#include "engine/strand_model.h"
#include "shaders/rod_constants.h"

namespace hairloom::runtime {
namespace {

constexpr std::size_t kBlocksPerPiece = 4;
/// Of half of a vertex' turn, squared: beyond, a pose folds hair so far that stiffness says nothing any more.
constexpr float kLeastCosine = 0.25f;
static_assert(kPoseSpeed == static_cast<float>(HAIRLOOM_POSE_SPEED));

/// The least rotation from one direction to another, both of length 1.
Quat arcBetween(Float3 from, Float3 to) {
    const Float3 axis = cross(from, to);
    const float c = dot(from, to);
    Quat turn{axis.x, axis.y, axis.z, 1.0f + c};
    if (c < -0.9999f) {
        const Float3 any =
            cross(from, std::abs(from.x) < 0.8f ? Float3{1.0f, 0.0f, 0.0f} : Float3{0.0f, 1.0f, 0.0f});
        turn = {any.x, any.y, any.z, 0.0f};
    }
    normalize(turn);
    return turn;
}

Float3 directionOf(Float3 segment) {
    const float size = length(segment);
    return size > 0.0f ? segment * (1.0f / size) : segment;
}

/// From vertex to vertex: how segments that have turned to other directions bend against each other.
class StrainWalk {
  public:
    /// Of the next vertex, whose outer segment has the direction `base` without load and turns to `to`, in
    /// the root's frame, without twist.
    Float3 strainOf(Float3 base, Float3 to) {
        Quat turn = arcBetween(rotate(before_, base), to) * before_;
        normalize(turn);
        const Quat relative = conjugate(before_) * turn;
        before_ = turn;
        return Float3{relative.x, relative.y, relative.z} * (relative.w < 0.0f ? -2.0f : 2.0f);
    }

  private:
    Quat before_;  ///< of the inner segment
};

Float3 at(const float* planes, std::size_t size, std::size_t i) {
    return {planes[i], planes[size + i], planes[2 * size + i]};
}
void put(Float3 value, float* planes, std::size_t size, std::size_t i) {
    planes[i] = value.x;
    planes[size + i] = value.y;
    planes[2 * size + i] = value.z;
}

/// The strands with a pose in place of their authored shape; clamped segments stay.
RestShape posedShape(const RestShape& shape, std::uint32_t clampedPoints, const PoseSet& poses,
                     std::size_t pose) {
    RestShape posed = shape;
    posed.straight = false;
    for (const Block& block : shape.blocks) {
        const std::size_t size = planeSize(block);
        float* const rest = posed.planes.data() + block.firstPlane * kRestPlanes;
        const float* const other = poses.of(shape, pose, block);
        const std::size_t first = std::size_t{clampedPoints - 1} * kBlockLanes;
        for (std::size_t plane = 0; plane < 3; ++plane)
            std::copy(other + plane * size + std::min(first, size), other + (plane + 1) * size,
                      rest + plane * size + std::min(first, size));
    }
    return posed;
}

}  // namespace

float poseRate(float amount) {
    constexpr float kHalf = static_cast<float>(HAIRLOOM_POSE_HALF_RATE),
                    kMost = static_cast<float>(HAIRLOOM_POSE_RATE);
    const float left = 1.0f - amount;
    return kHalf * amount < kMost * left ? kHalf * amount / left : kMost;
}

void RodPoses::take(const RestShape& shape, const SimulationSettings& settings, const RodRest& rest,
                    const PoseChange& change, const Host& host) {
    const std::span<const float> amounts = change.amounts;
    const bool on = std::any_of(amounts.begin(), amounts.end(), [](float amount) { return amount > 0.0f; });
    if (!on && !change.keepsMemory) {
        laid_ = {};
        planes_ = {};
        return;
    }
    // What is kept is laid again at once: later frames ask for no memory.
    const bool isLaid = !laid_.empty();
    if (change.others ? on || isLaid : on && !isLaid) lay(shape, settings, rest, change.poses, host);
    if (!on) {
        planes_.clear();
        return;
    }
    keepFloats(planes_, kPlanes * shape.planeFloats, host);
    inParallel(host, shape.blocks.size(), kBlocksPerPiece, [&](std::size_t begin, std::size_t end) {
        for (std::size_t b = begin; b < end; ++b) blend(shape, change.poses, amounts, shape.blocks[b]);
    });
}

void RodPoses::lay(const RestShape& shape, const SimulationSettings& settings, const RodRest& rest,
                   const PoseSet& poses, const Host& host) {
    laid_ = zeroFloats(kLaidPlanes * poses.count * shape.planeFloats, host);
    const std::uint32_t first = settings.clampedPoints - 1;
    for (std::size_t k = 0; k < poses.count; ++k) {
        const RestShape posed = posedShape(shape, settings.clampedPoints, poses, k);
        // As the authored shape, a pose carries the hair's weight.
        const RodRest free = makeRodRest(posed, settings, host);
        inParallel(host, shape.blocks.size(), kBlocksPerPiece, [&](std::size_t begin, std::size_t end) {
            for (std::size_t b = begin; b < end; ++b) {
                const Block& block = shape.blocks[b];
                const std::size_t size = planeSize(block);
                float* const laid = laid_.data() + kLaidPlanes * (k * shape.planeFloats + block.firstPlane);
                const float* const segments = posed.planes.data() + block.firstPlane * kRestPlanes;
                const float* const from = rest.planes.data() + block.firstPlane * rest.planeCount();
                const float* const to = free.planes.data() + block.firstPlane * free.planeCount();
                for (std::uint32_t lane = 0; lane < kBlockLanes; ++lane) {
                    Float3 position;
                    StrainWalk loaded, unloaded;
                    for (std::uint32_t p = 0; p < block.points; ++p) {
                        const std::size_t i = std::size_t{p} * kBlockLanes + lane;
                        put(position, laid, size, i);
                        if (p + 1 == block.points) break;
                        const Float3 segment = at(segments, size, i);
                        position = position + segment;
                        if (p < first || rest.parts == RodParts::chain) continue;
                        const Float3 base = at(from, size, i);
                        const Float3 stands = loaded.strainOf(base, directionOf(segment)),
                                     hangs = unloaded.strainOf(base, at(to, size, i));
                        // The weight is carried by the stiffness that vertices have, which in the pose may be
                        // made another, against a moment that is cos ½θ times as great where one turns by θ.
                        const float own = from[kRodBendPlane * size + i];
                        const float left = std::max(1.0f - 0.25f * dot(stands, stands), kLeastCosine);
                        const float share = own > 0.0f ? to[kRodBendPlane * size + i] / (own * left) : 1.0f;
                        put(stands - (stands - hangs) * share, laid + kLaidStrain * size, size, i);
                    }
                }
            }
        });
    }
}

/// What poses leave of the simulation is what each leaves of it in turn: 1 − Π (1 − amount · weight). The
/// poses share the rest by their amounts.
void RodPoses::blend(const RestShape& shape, const PoseSet& poses, std::span<const float> amounts,
                     const Block& block) {
    const std::size_t size = planeSize(block);
    float* const planes = planes_.data() + kPlanes * block.firstPlane;
    for (std::size_t i = 0; i < std::size_t{block.points} * kBlockLanes; ++i) {
        Float3 position, strain;
        float sum = 0.0f, left = 1.0f;
        for (std::size_t k = 0; k < poses.count; ++k) {
            const float share = amounts[k] * poses.of(shape, k, block)[3 * size + i];
            if (!(share > 0.0f)) continue;
            const float* const laid = laid_.data() + kLaidPlanes * (k * shape.planeFloats + block.firstPlane);
            position = position + at(laid, size, i) * share;
            strain = strain + at(laid + kLaidStrain * size, size, i) * share;
            sum += share;
            left *= 1.0f - share;
        }
        const float all = 1.0f - left, scale = sum > 0.0f ? 1.0f / sum : 0.0f;
        put(position * scale, planes, size, i);
        planes[kRatePlane * size + i] = poseRate(all);
        put(strain * (scale * all), planes + kStrainPlane * size, size, i);
    }
}

void RodPoses::show(const Block& block, RodView& view) const {
    if (!isOn()) return;
    const std::size_t size = planeSize(block);
    const float* const planes = planes_.data() + kPlanes * block.firstPlane;
    view.pose = {planes, size};
    view.poseRate = planes + kRatePlane * size;
    view.poseStrain = {planes + kStrainPlane * size, size};
}

}  // namespace hairloom::runtime
