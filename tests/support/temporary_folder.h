// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <filesystem>

namespace hairloom {

/// A new, empty folder that is gone with the object. Tests write nowhere else: several run at the same time,
/// in processes of their own, and what has a name that two of them know is taken from under one by the other.
class TemporaryFolder {
  public:
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }
    std::filesystem::path operator/(const std::filesystem::path& name) const { return path_ / name; }

  private:
    std::filesystem::path path_;
};

}  // namespace hairloom
