// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Contact of one strand with spheres at the end of a step.

#include "core/simulation/reference/strand.h"

namespace hairloom::reference {

struct ContactReport {
    std::size_t points = 0;    ///< points that touched
    double penetration = 0.0;  ///< deepest that is left, m
    double approach = 0.0;     ///< fastest approach that is left, m/s
};

/// Impulses of restitution (Eq. 20) and Coulomb friction on the points inside, found together with those that
/// hold the lengths (Gauss-Seidel between the two), each impulse also moving its point by half a step; then
/// points out along the radius (p_a of Eq. 21, the centre added) and lengths in turn until both hold.
/// Contacts last the whole step: of order 1.
ContactReport resolveContacts(const Physics& physics, const StrandShape& shape, double h,
                              std::span<const ColliderNow> colliders, StrandState& state);

}  // namespace hairloom::reference
