// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Whether a file is still the one that it was.

#include <cstdint>
#include <filesystem>
#include <utility>

namespace hairloom {

struct FileVersion {
    bool exists = false;
    std::pair<std::uint64_t, std::uint64_t> identity;  ///< volume and number of the file
    std::uint64_t bytes = 0;
    std::int64_t changed = 0;  ///< time of the last change of content, in the system's ticks

    bool operator==(const FileVersion&) const = default;
};

/// Links are followed.
FileVersion fileVersion(const std::filesystem::path& path);

}  // namespace hairloom
