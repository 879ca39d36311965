// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What an export wrote, how exactly, and what a consumer of the file would trip over.

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/groom/validate.h"
#include "exporters/safe_limits.h"

namespace hairloom {

/// An attribute that the file has, and how far its values are from the groom's; units of the attribute.
struct ComparedAttribute {
    std::string name;
    double maxError = 0;
};

/// Something authored that the file cannot have, and what to do about it.
struct LeftBehind {
    std::string what;
    std::string fix;
};

/// A level of detail that the file has, held against all strands at its distance.
struct WrittenLevel {
    std::string name;  ///< "cards-200"
    std::size_t cards = 0;
    std::size_t triangles = 0;
    std::uint64_t bytes = 0;  ///< on a GPU
    double distance = 0;      ///< metres from which on it serves
    double coverage = 1;      ///< times that of the strands
    double flip = 0;          ///< mean over its pictures
    double light = 1;         ///< times that of the strands
};

/// How far springs keep joints from the strands in an engine of that many updates a second, millimetres.
struct WrittenSpringRate {
    float hz = 0;
    double errorMm = 0, largestMm = 0;
};

struct ExportReport {
    std::string format;       ///< name of the format, as importStrands tells it
    std::size_t strands = 0;  ///< in the file
    std::size_t points = 0;   ///< in the file
    std::size_t frames = 0;   ///< of strands that move; 0 at rest
    std::size_t samples = 0;  ///< of these in time: more than frames where a shutter was asked for
    std::uint64_t bytes = 0;  ///< size of the file
    /// Largest distance of a point of the groom from its strand in the file, read back; millimetres. Nothing
    /// where the file has no point of a strand.
    std::optional<double> maxErrorMm;
    std::vector<ComparedAttribute> attributes;
    std::vector<std::string> names;  ///< of attributes of strands and points in the file, each once
    std::vector<LeftBehind> leftBehind;
    std::vector<Finding> findings;
    std::vector<WrittenLevel> levels;  ///< of files of cards, the nearest first
    float springHz = 0;                ///< that their springs are fitted for; 0: there are none
    std::vector<WrittenSpringRate> springRates;
    std::optional<SafeLimits> safeLimits;  ///< where the hairstyle was certified
    std::vector<std::string> companions;   ///< names of files that were written beside it
};

/// Keys: format, strands, points, frames (where strands move), samples (where these are more), bytes,
/// max_error_mm (null where nothing was measured), attributes (name, max_error), names, left_behind
/// (what, fix), findings (severity, what, where, fix); certificate (the fields of SafeLimits, where it was
/// made); companions (names, where there are some); of cards levels (name, cards, triangles, bytes,
/// distance_m, coverage, flip, light) and springs (hz, rates: hz, error_mm, largest_mm; where the file has
/// fitted ones).
nlohmann::json toJson(const ExportReport& report);

}  // namespace hairloom
