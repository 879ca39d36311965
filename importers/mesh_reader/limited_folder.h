// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The only files that the libraries which read meshes get to see: the one asked for, and regular files of
// sane size in its folder or below it.

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace hairloom {

class LimitedFolder {
  public:
    /// Of this file. Paths are UTF-8.
    explicit LimitedFolder(const std::string& file);

    /// The folder, absolute.
    std::string path() const;
    /// Whether the file may be read and is there; links count as where they lead.
    bool allows(const std::string& file) const;
    /// Errors: a file that is not allowed or cannot be read.
    Result<std::vector<std::byte>> read(const std::string& file) const;
    /// The first path asked for that lies outside; empty where all lie inside.
    const std::string& refused() const { return refused_; }

  private:
    std::filesystem::path folder_;
    mutable std::string refused_;
};

}  // namespace hairloom
