// SPDX-License-Identifier: MIT
// Poses: what an engine takes of them, and when strands follow others.
#include "engine/poses.h"

#include <algorithm>
#include <cmath>

#include "engine/checks.h"
#include "engine/engine_impl.h"

namespace hairloom::runtime {
namespace {

/// Metres: a segment of a pose that is shorter has no direction of its own.
constexpr float kNoDirection = 1e-9f;

std::string nameOfPose(std::size_t pose) {
    return "pose " + std::to_string(pose);
}

/// Segments of a strand of a pose, root to tip, in the root's frame.
class PosedStrand {
  public:
    PosedStrand(const PoseView& pose, const RestShape& shape, std::uint32_t strand)
        : points_(pose.positions_ss.subspan(shape.offsets[strand],
                                            shape.offsets[strand + 1] - shape.offsets[strand])),
          toRoot_(conjugate(shape.restRoots[strand].rotation)) {}

    /// Of length 1; `before` where the pose has none there.
    Float3 directionOf(std::uint32_t segment, Float3 before) const {
        const Float3 edge = points_[segment + 1] - points_[segment];
        const float size = length(edge);
        return size > kNoDirection ? rotate(toRoot_, edge * (1.0f / size)) : before;
    }

  private:
    std::span<const Float3> points_;
    Quat toRoot_;
};

}  // namespace

std::string validationError(std::span<const PoseView> poses, const RestShape& shape) {
    if (poses.size() > kMaxPoses)
        return std::to_string(poses.size()) + " poses; expected at most " + std::to_string(kMaxPoses);
    const std::size_t points = shape.offsets.back();
    for (std::size_t k = 0; k < poses.size(); ++k) {
        const PoseView& pose = poses[k];
        if (pose.positions_ss.size() != points)
            return nameOfPose(k) + " has " + std::to_string(pose.positions_ss.size()) +
                   " points; expected those of the strands, " + std::to_string(points);
        if (!pose.weights.empty() && pose.weights.size() != points)
            return nameOfPose(k) + " has " + std::to_string(pose.weights.size()) +
                   " weights; expected none or one for each point, " + std::to_string(points);
        for (std::size_t p = 0; p < points; ++p) {
            const Float3 at = pose.positions_ss[p];
            if (!isFinite(at) || std::max({std::abs(at.x), std::abs(at.y), std::abs(at.z)}) > kFarthest)
                return nameOfPose(k) + ": point " + std::to_string(p) + " is not a number within 1e6 m";
            if (!pose.weights.empty() && !(pose.weights[p] >= 0.0f && pose.weights[p] <= 1.0f))
                return nameOfPose(k) + ": the weight of point " + std::to_string(p) + " is not within 0 … 1";
        }
    }
    return {};
}

PoseSet makePoseSet(std::span<const PoseView> poses, const RestShape& shape) {
    PoseSet set;
    set.count = poses.size();
    set.planes.assign(PoseSet::kPosePlanes * poses.size() * shape.planeFloats, 0.0f);
    for (std::size_t k = 0; k < poses.size(); ++k) {
        for (const Block& block : shape.blocks) {
            const std::size_t size = planeSize(block);
            float* const planes = set.planes.data() + (set.of(shape, k, block) - set.planes.data());
            const float* const lengths = shape.planes.data() + block.firstPlane * kRestPlanes + 3 * size;
            for (std::uint32_t lane = 0; lane < kBlockLanes; ++lane) {
                const std::uint32_t strand = block.strandOfLane[lane];
                const PosedStrand posed(poses[k], shape, strand);
                Float3 direction{0.0f, 1.0f, 0.0f};
                for (std::uint32_t p = 0; p < block.points; ++p) {
                    const std::size_t i = std::size_t{p} * kBlockLanes + lane;
                    if (p + 1 < block.points) {
                        direction = posed.directionOf(p, direction);
                        const Float3 segment = direction * lengths[i];
                        planes[i] = segment.x;
                        planes[size + i] = segment.y;
                        planes[2 * size + i] = segment.z;
                    }
                    const auto& weights = poses[k].weights;
                    planes[3 * size + i] = weights.empty() ? 1.0f : weights[shape.offsets[strand] + p];
                }
            }
        }
    }
    return set;
}

bool takePoseAmounts(std::span<const float> amounts, std::span<float> kept) {
    bool changed = false;
    for (std::size_t k = 0; k < amounts.size(); ++k) {
        if (!std::isfinite(amounts[k])) continue;
        const float amount = std::clamp(amounts[k], 0.0f, 1.0f);
        changed = changed || amount != kept[k];
        kept[k] = amount;
    }
    return changed;
}

void standInPoses(const RestShape& shape, const PoseSet& poses, std::span<const float> amounts,
                  std::uint32_t clampedPoints, std::span<Float3> positions) {
    for (const Block& block : shape.blocks) {
        const std::size_t size = planeSize(block);
        const float* const rest = shape.planes.data() + block.firstPlane * kRestPlanes;
        const auto segmentIn = [&](const float* planes, std::size_t i) {
            return Float3{planes[i], planes[size + i], planes[2 * size + i]};
        };
        for (std::uint32_t lane = 0; lane < block.strands; ++lane) {
            const std::uint32_t first = shape.offsets[block.strandOfLane[lane]];
            positions[first] = {};
            for (std::uint32_t p = 1; p < block.points; ++p) {
                const std::size_t i = std::size_t{p - 1} * kBlockLanes + lane;
                const Float3 authored = segmentIn(rest, i);
                Float3 posed;
                float sum = 0.0f, left = 1.0f;
                for (std::size_t k = 0; k < poses.count && p >= clampedPoints; ++k) {
                    const float* const planes = poses.of(shape, k, block);
                    const float share = amounts[k] * planes[3 * size + i + kBlockLanes];
                    posed = posed + segmentIn(planes, i) * share;
                    sum += share;
                    left *= 1.0f - share;
                }
                Float3 segment = authored;
                if (sum > 0.0f) {
                    segment = authored * left + posed * ((1.0f - left) / sum);
                    const float mean = length(segment), lengthAtRest = rest[3 * size + i];
                    // Where a pose points back along the strand, there is no mean on the way to it.
                    segment = mean > 1e-3f * lengthAtRest ? segment * (lengthAtRest / mean) : authored;
                }
                positions[first + p] = positions[first + p - 1] + segment;
            }
        }
    }
}

std::string Engine::Impl::setPoses(std::span<const PoseView> poses) {
    if (std::string error = validationError(poses, *shape_); !error.empty()) return error;
    if (poses.empty() && !poses_) return {};
    poses_ = poses.empty() ? nullptr : makeShared<const PoseSet>(makePoseSet(poses, *shape_));
    poseAmounts_.assign(poses.size(), 0.0f);
    followPoses(true);
    replan({}, {}, state_.rootsMin_ws, state_.rootsMax_ws, 0.0f);
    return {};
}

void Engine::Impl::setPoseAmounts(std::span<const float> amounts) {
    if (amounts.empty() || amounts.size() != poseAmounts_.size()) return;
    if (takePoseAmounts(amounts, poseAmounts_)) followPoses(false);
}

/// `others`: poses have changed, not settings or amounts alone: strands that rest may have to move.
void Engine::Impl::followPoses(bool others) {
    static const PoseSet kNone;
    strands_->takePoses(*shape_, settings_, {poses_ ? *poses_ : kNone, poseAmounts_, others, keepsMemory_},
                        state_, host_);
    if (poses_) std::fill(state_.rests.begin(), state_.rests.end(), Rest{});
}

}  // namespace hairloom::runtime
