// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Places and sizes that operators find on a head of any size where nobody has named one.

#include <algorithm>
#include <string_view>

#include "core/groom/groom.h"
#include "hairloom/field.h"

namespace hairloom {

/// Metres, in the scalp's rest space, on the skin: where hair grows highest. The origin without a scalp.
Vec3f topOfHead(const Groom& groom);
/// The same for where hair whorls: as far behind the top as a fifth of what hair grows on is deep.
Vec3f crownOfHead(const Groom& groom);
/// How much larger than a person's head the one is that hair grows on, as a round number: 1 from children to
/// grown-ups, else 0.2, 0.5, 2, 5, 10 and so on, within 0.001 … 1000. By the scalp selection, or all of the
/// mesh where none is selected; below 1 where the whole mesh is that of a doll's head. 1 without a scalp.
float headScale(const Groom& groom);

/// Brings a length, or a number for each metre, that nobody chose to that size, inside the range of its
/// field. Others stay.
template <class S>
void fitToHead(S& settings, const runtime::Field<S>& field, float scale) {
    const std::string_view unit = field.unit;
    if (field.kind != runtime::FieldKind::Float || (unit != "m" && unit != "1/m")) return;
    const double factor = unit == "m" ? double{scale} : 1 / double{scale};
    field.set(settings, std::clamp(field.get(settings, 0) * factor, field.min, field.max), 0);
}

}  // namespace hairloom
