// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>

namespace hairloom::cli {

/// A bar on standard error while long work goes on; silent where that is no terminal.
class Progress {
  public:
    Progress(std::string what, std::size_t total);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// `note` stands behind the count.
    void done(std::size_t count, const std::string& note = {});

  private:
    std::string what_;
    std::size_t total_;
    bool shown_;
    int drawn_ = -1;  ///< filled cells last drawn
    std::string note_;
};

}  // namespace hairloom::cli
