// SPDX-License-Identifier: MIT
#pragma once
// What the engine's own sources share; not for callers.

#include <array>

#include "hairloom/engine.h"

namespace hairloom::runtime {

/// What all blocks share in one step.
struct Engine::Frame {
    const FrameInput* input;
    SubstepContext context;
    std::array<float, kWindModes> windFrom, windTo;
    bool windy;
    float rescale;  ///< new substep over old, 1 when equal
    bool newBend;
    const Kernels* kernels;
    Passes passes;  ///< of the plan; single ones where there is a clock between its stages
};

}  // namespace hairloom::runtime
