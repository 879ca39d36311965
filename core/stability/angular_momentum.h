// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How much angular momentum a strand loses while nothing acts on it (Rünz 2012, Section 3.2: stiff springs
// and implicit steps lose it).

#include "core/base/result.h"
#include "hairloom/settings.h"

namespace hairloom {

/// The loss of one strand that spins about its root, on which it hinges freely: whatever holds its shape and
/// length acts along the strand, and has no lever about the root.
struct MomentumLoss {
    double rate = 0;       ///< rad/s, of the spin at the start: its momentum over its moment of inertia
    double lost = 0;       ///< share of the momentum that is gone after the time, negative where it grew
    double predicted = 0;  ///< share that backward Euler takes from a rigid spin, backwardEulerLoss()
};

/// Of a straight strand of 30 cm and 16 points, which falls from the level for 0.2 s and then spins for
/// `seconds` without weight, with the shape, length and integrator of `settings`; all else that brakes is
/// off. Errors: settings that the engine refuses, a strand that is not finite in the end.
Result<MomentumLoss> angularMomentumLoss(const runtime::SimulationSettings& settings, double seconds = 1);

/// What backward Euler in steps of h takes from a rigid body that spins at ω₀. The force of a step is along
/// the new position x', so L' = x' × v = L + h v' × v, and as v' is v turned by ωh, L' = L (1 − ωh sin ωh):
/// dω/dt = −ω³ h, of which L(t)/L(0) = 1/√(1 + 2 ω₀² h t).
double backwardEulerLoss(double rate, double step, double seconds);

}  // namespace hairloom
