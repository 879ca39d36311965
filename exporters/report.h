// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What an export wrote, how exactly, and what a consumer of the file would trip over.

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "core/groom/validate.h"

namespace hairloom {

struct ExportReport {
    std::string format;       ///< name of the format, as importStrands tells it
    std::size_t strands = 0;  ///< in the file
    std::size_t points = 0;   ///< in the file
    std::uint64_t bytes = 0;  ///< size of the file
    /// Largest distance of a point of the groom from its strand in the file, read back; millimetres.
    double maxErrorMm = 0;
    std::vector<Finding> findings;
};

/// Keys: format, strands, points, bytes, max_error_mm, findings (severity, what, where, fix).
nlohmann::json toJson(const ExportReport& report);

}  // namespace hairloom
