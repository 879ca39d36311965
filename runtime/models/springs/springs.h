// SPDX-License-Identifier: MIT
#pragma once
// Strands as masses and springs (Rünz 2012; docs/engine.md): their arrays.

#include <cstddef>
#include <cstdint>

#include "engine/strand_model.h"
#include "models/springs/spring_block.h"

namespace hairloom::runtime {

const Model& springModel();

/// Arrays of angular and flexion springs, derived from rest shape, settings and substep.
struct Bend {
    Floats
        planes;  ///< per block: stiffness, then 3 of the factors, then 3 of the targets where there are any
    bool factored = false;
    bool targets = false;
    float substep = 0.0f;  ///< seconds that `planes` was made for; 0 for not yet

    std::size_t planeCount() const { return 1u + (factored ? 3u : 0u) + (targets ? 3u : 0u); }
};

/// Planes of integrators that evaluate forces: start, stepDisplacement; RK4 also kick, sum and
/// stepDisplacementSum.
inline constexpr std::size_t kEvaluationPlanes = 6;
inline constexpr std::size_t kRungeKuttaPlanes = 15;

/// State::own of springs: BlockView's tension of each segment, while it is needed.
inline constexpr std::size_t kOwnTensions = 0;

/// Everything the kernels of a block need; `bend` and `evaluation` may be empty.
struct SpringArrays {
    const RestShape& shape;
    State& state;
    const Bend& bend;
    Floats& evaluation;
    std::size_t evaluationPlanes;
};
void fillSprings(const SpringArrays& arrays, std::size_t block, std::uint32_t clampedPoints,
                 SpringBlock& view);

/// Fills the planes of block `b` for substeps of h seconds.
void fillBend(const RestShape& shape, const SimulationSettings& settings, float h, std::size_t block,
              Bend& bend);

/// q of docs/engine.md, "Integrators": what keeps the implicit angular springs stable and fades fast waves.
float bendRate(const SimulationSettings& settings, float h, bool curved);

}  // namespace hairloom::runtime
