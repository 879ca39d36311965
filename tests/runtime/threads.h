// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

#include "hairloom/host.h"

namespace hairloom::runtime {

/// A host whose pieces are taken by threads in whatever order they come.
inline Host hostWithThreads(unsigned threads, bool backwards = false) {
    Host host;
    host.parallelFor = [=](std::size_t count, std::size_t grain, const Host::Body& body) {
        const std::size_t pieces = (count + grain - 1) / grain;
        std::atomic<std::size_t> next{0};
        std::vector<std::thread> pool;
        for (unsigned t = 0; t < threads; ++t) {
            pool.emplace_back([&] {
                for (std::size_t i = next++; i < pieces; i = next++) {
                    const std::size_t piece = backwards ? pieces - 1 - i : i;
                    body(piece * grain, std::min(count, (piece + 1) * grain));
                }
            });
        }
        for (std::thread& thread : pool) thread.join();
    };
    return host;
}

}  // namespace hairloom::runtime
