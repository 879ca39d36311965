// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// One step of a strand: a rule with the force at the share w of the step, and constraints on position and
// velocity at its end, after RATTLE (Andersen 1983),
//   M (x₁ − x₀ − h v₀) = w h² f(x₀ + w (x₁ − x₀), (x₁ − x₀)/h) + G(x₀)ᵀ λ,    c(x₁) = 0,
//   M (v₁ − (x₁ − x₀)/h) = (1 − w) h f(same) + G(x₁)ᵀ μ,                       G(x₁) v₁ = 0.
// With w = ½ it is its own inverse under h → −h, so of order 2, with even powers of h only in its error;
// without constraints it is the implicit midpoint rule, which is stable for any stiffness and damps nothing
// by itself. With w = 1 it is the implicit Euler method, which damps what is fast.

#include "core/simulation/reference/banded_matrix.h"
#include "core/simulation/reference/strand.h"

namespace hairloom::reference {

/// Where the clamped points are at the end of a step.
struct ClampedEnd {
    std::vector<Vec3d> x, v;  ///< one per clamped point
};

/// Memory of the solve, to be kept from one step to the next.
struct Workspace {
    BandedMatrix matrix;
    std::vector<double> rightSide;
    std::vector<double> multipliers;  ///< λ of the last step
    std::vector<Vec3d> force;
};

/// Advances by h ≠ 0 with w = `weight`; `around` is the world at the share w of the step. False when Newton's
/// iteration does not converge: the state is then the best it had.
bool substep(const Physics& physics, const StrandShape& shape, double h, double weight,
             const Environment& around, const ClampedEnd& end, StrandState& state, Workspace& work);

}  // namespace hairloom::reference
