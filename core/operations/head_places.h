// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Places that operators find on a head of any size where nobody has named one.

#include <string_view>

#include "core/groom/groom.h"

namespace hairloom {

/// Metres, in the scalp's rest space, on the skin: where hair grows highest. The origin without a scalp.
Vec3f topOfHead(const Groom& groom);
/// The same for where hair whorls: as far behind the top as a fifth of what hair grows on is deep.
Vec3f crownOfHead(const Groom& groom);
/// Where a point of that name lies that is zero: the crown of "crown", the top of the head for others.
Vec3f placeFound(const Groom& groom, std::string_view setting);

}  // namespace hairloom
