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

}  // namespace hairloom::runtime
