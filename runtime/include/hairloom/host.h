// SPDX-License-Identifier: MIT
#pragma once
// What a game lends the engine. Everything has a default that needs no game.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string_view>

namespace hairloom::runtime {

struct Host {
    using Body = std::function<void(std::size_t begin, std::size_t end)>;
    /// Calls body for pieces of [0, count) of about `grain` elements, on any threads, and returns when all
    /// are done. Empty: serial.
    std::function<void(std::size_t count, std::size_t grain, const Body& body)> parallelFor;
    /// Receives what is worth telling a developer. Empty: silence.
    std::function<void(std::string_view)> log;
    /// Nanoseconds of a steady clock. Empty: stages are not timed and cost nothing for it.
    std::function<std::uint64_t()> nanoseconds;
};

}  // namespace hairloom::runtime
