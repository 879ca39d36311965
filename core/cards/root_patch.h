// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The piece of scalp that the roots of a card stand on.

#include <span>

#include "core/cards/strip.h"

namespace hairloom::cards {

/// A rectangle just above the scalp; world space, metres.
struct RootPatch {
    Vec3f middle = Vec3f::Zero();
    Vec3f along = Vec3f::UnitZ();   ///< unit, the way the hair lies
    Vec3f across = Vec3f::UnitX();  ///< unit
    Vec3f normal = Vec3f::UnitY();  ///< unit, outwards: along × across
    float halfLength = 0, halfWidth = 0;
};

/// Of at least one strand, whose strip says which way they lie.
RootPatch rootPatch(const EvenHair& hair, std::span<const std::uint32_t> strands, const Strip& strip,
                    std::span<const Vec3f> rootNormals_ws);

}  // namespace hairloom::cards
