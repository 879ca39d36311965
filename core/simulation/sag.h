// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How well a groom holds its authored shape under gravity and contact.

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/groom/groom.h"

namespace hairloom {

struct Sag {
    double meanMm = 0;  ///< of all points, from where they are authored
    double maxMm = 0;
    /// Share of its weight that a strand does not carry in the authored shape, the largest: 0 hangs still, 1
    /// falls freely.
    double residual = 0;
    std::vector<float> strandMm;  ///< the largest of each strand
};

/// A strand that does not hold its shape.
struct SaggingStrand {
    std::uint32_t strand;
    double mm;
    std::string reason;
};

/// Lets the hair hang for two seconds from its authored shape, in still air on a head at rest. Errors: as
/// Simulation::make.
Result<Sag> measureSag(const Groom& groom);

/// The groom as rods that carry their weight in the authored shape.
Groom holdingItsShape(const Groom& groom);

/// Strands that sag by more than `limitMm`, worst first, each with why: it stands in a collision sphere that
/// pushes it out, hangs on one, or has no stiffness.
std::vector<SaggingStrand> strandsThatSag(const Groom& groom, const Sag& sag, double limitMm);

}  // namespace hairloom
