// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A measured fibre applied to a whole groom.

#include "core/groom/groom.h"
#include "hairloom/presets.h"

namespace hairloom {

/// Sets stiffness, cross-section, thickness, colours and melanin. docs/cli.md lists the fields. Returns their
/// number.
std::size_t applyPreset(const runtime::HairPreset& preset, Groom& groom);

}  // namespace hairloom
