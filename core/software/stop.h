// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Work that is left where it is once nobody waits for it.

#include <atomic>
#include <functional>
#include <memory>
#include <string_view>

#include "core/base/parallel.h"

namespace hairloom::software {

/// True: what the device does is no longer wanted. Null: everything is.
using Stop = std::shared_ptr<const std::atomic<bool>>;

/// Error of a command list that a stop has cut short.
inline constexpr std::string_view kDropped = "nobody waits for this image";

inline bool isAsked(const Stop& stop) {
    return stop != nullptr && stop->load(std::memory_order_relaxed);
}

/// As parallelFor(); pieces that begin after a stop was asked for are left out.
inline void parallelUntil(const Stop& stop, std::size_t count, std::size_t grain,
                          const std::function<void(std::size_t, std::size_t)>& body) {
    parallelFor(count, grain, [&](std::size_t begin, std::size_t end) {
        if (!isAsked(stop)) body(begin, end);
    });
}

}  // namespace hairloom::software
