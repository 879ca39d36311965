// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The factors by which the lanes of a strand solve their angular springs together (solveBend() of
// runtime/shaders/lanes_bend.hlsli): cyclic reduction of the pentadiagonal matrix, whose rows are taken in
// pairs, so that it is tridiagonal in 2×2 blocks. They are of the matrix alone, and made once.

#include <span>
#include <vector>

#include "core/gpu_simulation/strand_batch.h"
#include "runtime/models/springs/springs.h"

namespace hairloom::gpu_simulation {

/// Steps until all pairs of so many points are told to each other. At least 1.
std::uint32_t reductionSteps(std::uint32_t points);

/// A matrix of `points` rows as its LDLᵀ; rows outside [first, end) stand alone.
struct BendFactors {
    std::uint32_t first = 0, end = 0;
    std::span<const double> inverseDiagonal, lower1, lower2;  ///< per row; lower1 couples to the row before
};

/// reductionSteps(points) + 1 quads for each row, row after row: for each step what to add of the two rows of
/// the pair that is 2, 4, 8 … rows before, and of that after; then the row's own and the other of its pair,
/// which give the solution, and two zeros.
std::vector<shaders::float4> reduce(const BendFactors& factors, std::uint32_t points);

/// Those of all strands of a batch, plane after plane; the third component of the last plane is the
/// stiffness.
std::vector<shaders::float4> reducedBend(const runtime::RestShape& shape, const StrandBatch& batch,
                                         std::uint32_t clampedPoints, const runtime::Bend& bend);

}  // namespace hairloom::gpu_simulation
