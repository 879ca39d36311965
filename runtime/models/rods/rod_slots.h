// SPDX-License-Identifier: MIT
#pragma once
// Rods as the kernel of a GPU wants them (shaders/rod_storage.hlsli).

#include <cstdint>
#include <span>

#include "engine/slots.h"
#include "hairloom/memory.h"
#include "models/rods/rod_poses.h"
#include "models/rods/rods.h"
#include "shaders/rod_types.h"

namespace hairloom::runtime {

struct RodSlots {
    Vector<shaders::float4> rest;
    Vector<float> masses;
    Vector<std::uint32_t> curved;  ///< per block
};
RodSlots rodsOfSlots(const RestShape& shape, const Slots& slots, const RodRest& rods);

/// What rods follow now, two for each point.
Vector<shaders::float4> posesOfSlots(const RestShape& shape, const Slots& slots, const RodPoses& poses);

/// The planes of the device are those of motion, strains and loads, then the rows of strands, then, with a
/// body, the planes of `folds`; 0 where the state has none.
Vector<float> rodStateOfSlots(const RestShape& shape, const Slots& slots, const State& state,
                              bool folds = false);
/// The reverse.
void rodStateToBlocks(const RestShape& shape, const Slots& slots, std::span<const float> rods, State& state);

/// `before`: seconds of the last substep, 0 before the first. `fresh`: HAIRLOOM_RODS_FRESH … or 0.
shaders::RodConstants rodConstants(const SubstepContext& context, const Wind& wind, float before,
                                   const Slots& slots, std::uint32_t fresh);

}  // namespace hairloom::runtime
