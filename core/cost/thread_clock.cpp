// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/cost/thread_clock.h"

#ifdef _WIN32
#include <chrono>
#else
#include <ctime>
#endif

namespace hairloom {

std::uint64_t threadNanoseconds() {
#ifdef _WIN32
    // GetThreadTimes counts in slices of 16 ms.
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(now).count());
#else
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<std::uint64_t>(now.tv_sec) * 1'000'000'000u + static_cast<std::uint64_t>(now.tv_nsec);
#endif
}

}  // namespace hairloom
