// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Repeated measurements.

#include <functional>
#include <string>
#include <vector>

#include "benchmarks/benchmark.h"
#include "core/base/stopwatch.h"

namespace hairloom::benchmarks {

/// The repetitions of one measurement, in the order in which they ran; at least one.
struct Measurement {
    std::string name;
    std::string unit;
    std::vector<double> values;

    double median() const;
};

/// name, n, median, min, max, unit.
Report rowOf(const Measurement& measurement);

/// The rounds of one repetition: `while (rounds.next()) work();` goes on for a while, and at least once.
class Rounds {
  public:
    explicit Rounds(double seconds) : seconds_(seconds) {}

    bool next();
    /// What runs until resume() is not measured.
    void pause() { spent_ += watch_.seconds(); }
    void resume() { watch_ = Stopwatch(); }
    /// Milliseconds of one round; after next() was false.
    double milliseconds() const { return 1e3 * spent_ / static_cast<double>(rounds_); }

  private:
    double seconds_;
    double spent_ = 0;
    std::size_t rounds_ = 0;
    bool running_ = false;
    Stopwatch watch_;
};

/// Does nothing, out of the compiler's sight.
void lookAt(const void* something);
/// A compiler must make `value`.
template <class T>
void keep(const T& value) {
    lookAt(&value);
}

/// Measurements in milliseconds a round, one after the other, until one fails.
class Timings {
  public:
    explicit Timings(const Options& options) : options_(options) {}

    void measure(const std::string& name, const std::function<Status(Rounds&)>& work);
    /// What was measured elsewhere.
    void add(Measurement measurement);
    /// Reports of what was measured, under the benchmark's name, or the first failure.
    Result<Outcome> outcome(const std::string& benchmark) const;

  private:
    const Options& options_;
    Status status_;
    std::vector<Measurement> measurements_;
};

}  // namespace hairloom::benchmarks
