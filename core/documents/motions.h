// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Motions of a groom's head by the names that people choose them by.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "core/animation/actor.h"
#include "core/simulation/motion.h"
#include "core/simulation/time_line_motion.h"

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

/// How long a motion plays, and how finely.
struct MotionSpan {
    FramePace pace;
    std::uint64_t frames = 60;
};
/// As somebody asked, else by the groom's time line where that is the motion, else 60 frames at 60 a second
/// without pre-roll.
MotionSpan motionSpanOf(std::string_view motion, const Groom& groom, std::optional<float> framesPerSecond,
                        std::optional<std::uint64_t> frames, std::optional<std::uint64_t> preRoll);

}  // namespace hairloom
