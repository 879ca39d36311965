// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A file that says, by being there and held, that its process runs. The system lets go of it however the
// process ends.

#include <filesystem>
#include <memory>

#include "core/base/result.h"

namespace hairloom {

class HeldFile {
  public:
    /// Makes the file or takes over one that nobody holds. Errors: held by somebody, the folder cannot be
    /// written.
    static Result<HeldFile> hold(const std::filesystem::path& path);
    HeldFile(HeldFile&&) noexcept;
    HeldFile& operator=(HeldFile&&) noexcept;
    /// Takes the file away.
    ~HeldFile();

    const std::filesystem::path& path() const;

  private:
    struct Impl;
    explicit HeldFile(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace hairloom
