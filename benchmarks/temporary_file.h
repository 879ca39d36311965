// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

namespace hairloom::benchmarks {

/// A path in the system's temporary folder; what was written there goes when this does.
struct TemporaryFile {
    std::filesystem::path path;

    explicit TemporaryFile(const std::string& name) : path(std::filesystem::temp_directory_path() / name) {}
    ~TemporaryFile() {
        std::error_code ignored;
        std::filesystem::remove(path, ignored);
    }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;
};

}  // namespace hairloom::benchmarks
