// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "core/operations/strand_edit.h"

namespace hairloom {

/// fieldsOf() describes the members.
struct CollideSettings {
    float distance = 0.002f;
};
std::span<const Field<CollideSettings>> fieldsOf(const CollideSettings&);

/// Pushes points that are nearer to the skin out to the distance, lengths kept; other strands keep their
/// bits. Returns the number of strands touched. Error: no scalp.
Result<std::size_t> collide(Groom& groom, const CollideSettings& settings, const Region& region = {});

}  // namespace hairloom
