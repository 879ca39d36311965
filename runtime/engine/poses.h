// SPDX-License-Identifier: MIT
#pragma once
// Poses that strands follow, as an engine keeps them: laid out as its rest shape, so that models read both
// alike.

#include <cstddef>
#include <span>
#include <string>

#include "engine/state.h"
#include "hairloom/strands.h"

namespace hairloom::runtime {

/// Other shapes of the strands of one rest shape. Immutable, shared by copies of an engine.
struct PoseSet {
    std::size_t count = 0;
    /// Per pose and block kPosePlanes: x, y, z of segment s at [s · kBlockLanes + lane], as
    /// BlockView::rest of the same length, metres; the weight of point p at [p · kBlockLanes + lane].
    Floats planes;

    /// The planes of a pose in a block.
    const float* of(const RestShape& shape, std::size_t pose, const Block& block) const {
        return planes.data() + kPosePlanes * (pose * shape.planeFloats + block.firstPlane);
    }
    static constexpr std::size_t kPosePlanes = 4;
};

/// Metres per second at which poses draw hair at most, relative to the head.
inline constexpr float kPoseSpeed = 2.5f;

/// Empty, or in words why these are no poses of those strands (Engine::setPoses()).
std::string validationError(std::span<const PoseView> poses, const RestShape& shape);
/// `poses` are sound.
PoseSet makePoseSet(std::span<const PoseView> poses, const RestShape& shape);

/// Takes amounts, as many as there are, into `kept`, within 0 … 1; what is no number stays. Whether one is
/// another than before.
bool takePoseAmounts(std::span<const float> amounts, std::span<float> kept);

/// Where points stand in the poses by their amounts, while nothing else moves them: metres from their roots,
/// in the roots' frames, in the order of strands. The first `clampedPoints` are as authored. Segments keep
/// their lengths: each points where its directions at rest and in the poses do on the mean.
void standInPoses(const RestShape& shape, const PoseSet& poses, std::span<const float> amounts,
                  std::uint32_t clampedPoints, std::span<Float3> positions);

/// What models are told of poses.
struct PoseChange {
    const PoseSet& poses;
    std::span<const float> amounts;
    bool others;       ///< poses have changed, not amounts or settings alone
    bool keepsMemory;  ///< while all amounts are 0, for the frame in which one comes back
};

}  // namespace hairloom::runtime
