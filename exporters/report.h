// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What an export wrote, how exactly, and what a consumer of the file would trip over.

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "core/groom/validate.h"

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

struct ExportReport {
    std::string format;       ///< name of the format, as importStrands tells it
    std::size_t strands = 0;  ///< in the file
    std::size_t points = 0;   ///< in the file
    std::size_t frames = 0;   ///< of strands that move; 0 at rest
    std::uint64_t bytes = 0;  ///< size of the file
    /// Largest distance of a point of the groom from its strand in the file, read back; millimetres.
    double maxErrorMm = 0;
    std::vector<ComparedAttribute> attributes;
    std::vector<LeftBehind> leftBehind;
    std::vector<Finding> findings;
};

/// Keys: format, strands, points, frames (where strands move), bytes, max_error_mm, attributes (name,
/// max_error), left_behind (what, fix), findings (severity, what, where, fix).
nlohmann::json toJson(const ExportReport& report);

}  // namespace hairloom
