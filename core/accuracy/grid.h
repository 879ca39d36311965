// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Grids of settings: axes by the names of fields, so that a new field needs nothing here.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "hairloom/settings.h"

namespace hairloom {

/// What varies: a field of runtime::SimulationSettings by its name (an enumeration by its index), or one of
/// those below.
struct GridAxis {
    std::string field;
    std::vector<double> values;
    bool operator==(const GridAxis&) const = default;
};
/// Points per strand, resampled evenly by arc length; 2 … runtime::kMaxPoints.
inline constexpr std::string_view kPointsAxis = "points";
/// Threads that the engine may use, 0 for all.
inline constexpr std::string_view kThreadsAxis = "threads";

/// What moves the strands: "cpu" or "gpu", by its index.
inline constexpr std::string_view kEngineAxis = "engine";
/// Where substeps see the head: at the "ends" of frames, straight between them, or at their "quarters", as
/// the tool itself simulates; by its index.
inline constexpr std::string_view kHeadSeenAxis = "headSeen";
/// Hair-hair collision through a volume between frames: 0 or 1.
inline constexpr std::string_view kHairVolumeAxis = "hairVolume";
/// Collision spheres that stay, the first of the groom's.
inline constexpr std::string_view kSpheresAxis = "spheres";
/// Strands that are simulated, found by clustering; each other one goes as its guide does, from its own root.
inline constexpr std::string_view kGuidesAxis = "guides";
/// Hairs that follow each strand that is simulated: they cost time and change no motion.
inline constexpr std::string_view kHairsPerGuideAxis = "hairsPerGuide";

/// Whether its values are names.
bool isEnumeration(std::string_view field);

/// The value as a person writes it: "verlet", "16", "0.25".
std::string axisValueText(const GridAxis& axis, double value);

/// Values of an axis as they stand on a command line; one given twice counts once. Errors: no such field, a
/// text that is neither a number nor one of its choices, a value out of range, no value.
Result<GridAxis> parseAxis(std::string_view field, const std::vector<std::string>& values);

/// Errors as of parseAxis.
Status checkAxis(const GridAxis& axis);

/// One value of each axis; the last axis turns fastest.
std::vector<std::vector<double>> combinations(const std::vector<GridAxis>& axes);

std::optional<std::size_t> findAxis(const std::vector<GridAxis>& axes, std::string_view field);

/// Sets the fields that the axes name; the axes have passed checkAxis.
void applyValues(const std::vector<GridAxis>& axes, const std::vector<double>& values,
                 runtime::SimulationSettings& settings);

}  // namespace hairloom
