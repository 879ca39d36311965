// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Where time goes. A scope costs two clock reads and two additions to its own counter (below 100 ns; see
// benchmarks/base). Names are string literals; each HAIRLOOM_PROFILE line is one counter shared by all
// threads.

#include <atomic>
#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

namespace hairloom::profiler {

class Counter {
  public:
    /// `name` must outlive the program. Registers itself; counters live for ever.
    explicit Counter(const char* name);
    Counter(const Counter&) = delete;
    Counter& operator=(const Counter&) = delete;

    void add(std::uint64_t nanoseconds) {
        calls_.fetch_add(1, std::memory_order_relaxed);
        nanoseconds_.fetch_add(nanoseconds, std::memory_order_relaxed);
    }

  private:
    friend struct Registry;
    const char* name_;
    std::atomic<std::uint64_t> calls_{0};
    std::atomic<std::uint64_t> nanoseconds_{0};
};

class Scope {
  public:
    explicit Scope(Counter& counter) : counter_(counter), start_(std::chrono::steady_clock::now()) {}
    ~Scope() {
        const auto spent = std::chrono::steady_clock::now() - start_;
        counter_.add(
            static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(spent).count()));
    }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

  private:
    Counter& counter_;
    std::chrono::steady_clock::time_point start_;
};

struct Row {
    std::string name;
    std::uint64_t calls;
    double milliseconds;  ///< summed over threads
};

/// All counters that were hit since the last reset, the costliest first; those of one name are added up.
std::vector<Row> report();
void reset();

}  // namespace hairloom::profiler

#define HAIRLOOM_PROFILE_JOIN2(a, b) a##b
#define HAIRLOOM_PROFILE_JOIN(a, b) HAIRLOOM_PROFILE_JOIN2(a, b)
/// Times the rest of the enclosing block under `name`.
#define HAIRLOOM_PROFILE(name)                                                                  \
    static ::hairloom::profiler::Counter HAIRLOOM_PROFILE_JOIN(profileCounter, __LINE__)(name); \
    const ::hairloom::profiler::Scope HAIRLOOM_PROFILE_JOIN(                                    \
        profileScope, __LINE__)(HAIRLOOM_PROFILE_JOIN(profileCounter, __LINE__))
