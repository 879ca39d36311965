// SPDX-License-Identifier: GPL-3.0-or-later
// The loops of parallel.h on plain threads. ThreadSanitizer cannot see how TBB, which is not built with it,
// hands work over, and would take every such hand-over for a race.
#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

#include "core/base/parallel.h"

namespace hairloom {
namespace {

std::atomic<std::size_t>& limit() {
    static std::atomic<std::size_t> count = 0;
    return count;
}

/// Loops inside of loops run where they are, as they would end up doing with all threads busy.
thread_local bool insideLoop = false;

}  // namespace

void setThreadCount(std::size_t count) {
    limit() = count;
}

std::size_t threadCount() {
    const std::size_t count = limit();
    // At least two, so that there is something to find on any machine.
    return count > 0 ? count : std::max(2u, std::thread::hardware_concurrency());
}

void parallelFor(std::size_t count, std::size_t grain,
                 const std::function<void(std::size_t, std::size_t)>& body) {
    grain = std::max<std::size_t>(grain, 1);
    const std::size_t pieces = (count + grain - 1) / grain;
    std::atomic<std::size_t> next = 0;
    const auto work = [&] {
        const bool outer = insideLoop;
        insideLoop = true;
        for (std::size_t i = next++; i < pieces; i = next++)
            body(i * grain, std::min(count, (i + 1) * grain));
        insideLoop = outer;
    };
    const std::size_t helpers = insideLoop ? 0 : std::min(threadCount(), pieces);
    std::vector<std::thread> threads;
    for (std::size_t t = 1; t < helpers; ++t) threads.emplace_back(work);
    work();
    for (std::thread& thread : threads) thread.join();
}

}  // namespace hairloom
