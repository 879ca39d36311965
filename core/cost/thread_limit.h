// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>

#include "core/base/parallel.h"

namespace hairloom {

/// Other numbers of threads while it lives, then as before.
class ThreadLimit {
  public:
    ThreadLimit() = default;
    explicit ThreadLimit(std::size_t threads) : before_(threadCount()) { setThreadCount(threads); }
    ~ThreadLimit() {
        if (before_) setThreadCount(*before_);
    }
    ThreadLimit(const ThreadLimit&) = delete;
    ThreadLimit& operator=(const ThreadLimit&) = delete;

  private:
    std::optional<std::size_t> before_;
};

}  // namespace hairloom
