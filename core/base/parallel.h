// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Loops over all cores. The work is cut into the same pieces whatever the number of threads, so a body that
// writes only to its own piece gives the same bits for any number.

#include <cstddef>
#include <functional>

namespace hairloom {

/// Number of threads that later loops use; 0 means one per core.
void setThreadCount(std::size_t count);
std::size_t threadCount();

/// Calls body(begin, end) for consecutive pieces of [0, count), each of `grain` elements but perhaps the
/// last. Returns when all are done. The body must not throw.
void parallelFor(std::size_t count, std::size_t grain,
                 const std::function<void(std::size_t, std::size_t)>& body);

}  // namespace hairloom
