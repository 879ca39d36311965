// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A groom's materials as the shaders of games take them.

#include "core/base/result.h"
#include "core/groom/groom.h"
#include "exporters/hair_looks.h"

namespace hairloom {

/// As pictures show the hair, with tables of light in fibres for materials of Marschner and Sadeghi (both are
/// Marschner's there). Of the follow hairs where the groom has some. Errors: those of bindFollowHairs().
Result<HairLooks> hairLooks(const Groom& groom);

}  // namespace hairloom
