// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Motions of a groom's head by the names that people choose them by.

#include <memory>
#include <string>
#include <string_view>

#include "core/animation/actor.h"
#include "core/simulation/motion.h"

namespace hairloom {

/// The character with skeleton and clips that a groom's scalp came from, or of another file where `character`
/// names one. Errors: the groom names no file, and those of the file.
Result<std::shared_ptr<const Actor>> loadActor(const std::string& character, const Groom& groom);

/// What the groom's own time line says.
inline constexpr std::string_view kTimeLineMotion = "timeline";

/// The motion of that name: none, spin, nod, clip:NAME, timeline, or a JSON file of keys (keyed_motion.h).
/// Clips come from `character`, or where that is empty from the file that the groom's scalp came from.
Result<std::unique_ptr<HeadMotion>> makeMotion(const std::string& name, const std::string& character,
                                               const Groom& groom);

}  // namespace hairloom
