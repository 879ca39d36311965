// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// As much hair between the strands as a person has.

#include "core/base/result.h"
#include "core/groom/groom.h"

namespace hairloom {

/// Hairs on each cm² of a scalp: a usual value of grown-ups.
inline constexpr double kHairsPerCm2 = 160;

/// Sets the follow hairs of each guide so that the selected scalp, as dense as its density map is, has that
/// many, and the blend to 1, so that they spread between the guides. On a head that is not of a person's size
/// (headScale()) hairs and wisps are as much thicker and hairs as much sparser, where those sizes are the
/// defaults. Errors: no strands, or no scalp where hair grows.
Status fillHead(Groom& groom);

/// Follow hairs of each of so many guides, ≥ 1, with which the groom's scalp has that many hairs. The groom
/// has a scalp, and `guides` is not 0.
std::uint32_t followHairsToFill(const Groom& groom, std::size_t guides);
/// Whether nobody has chosen other follow hairs: there is no hair yet and they are as in a new groom, or they
/// are what fillHead() makes. Hair that is placed then fills the head by itself.
bool isFilledByItself(const Groom& groom);

}  // namespace hairloom
