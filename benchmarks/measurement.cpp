// SPDX-License-Identifier: GPL-3.0-or-later
#include "benchmarks/measurement.h"

#include <algorithm>

#include "core/cost/statistics.h"

namespace hairloom::benchmarks {

double Measurement::median() const {
    return quartiles(values).median;
}

Report rowOf(const Measurement& measurement) {
    const auto [minimum, maximum] = std::ranges::minmax(measurement.values);
    return Report{{"name", measurement.name},
                  {"n", measurement.values.size()},
                  {"median", measurement.median()},
                  {"min", minimum},
                  {"max", maximum},
                  {"unit", measurement.unit}};
}

void lookAt(const void*) {}

bool Rounds::next() {
    if (running_) {
        pause();
        ++rounds_;
        if (spent_ >= seconds_) return false;
    }
    running_ = true;
    resume();
    return true;
}

void Timings::measure(const std::string& name, const std::function<Status(Rounds&)>& work) {
    constexpr int kUsualRepetitions = 5;
    if (!status_) return;
    Measurement measurement{name, "ms", {}};
    for (int r = 0; r < options_.repetitions.value_or(kUsualRepetitions); ++r) {
        Rounds rounds(options_.quick ? 0.01 : 0.2);
        if (status_ = work(rounds); !status_) return;
        measurement.values.push_back(rounds.milliseconds());
    }
    measurements_.push_back(std::move(measurement));
}

void Timings::add(Measurement measurement) {
    if (status_) measurements_.push_back(std::move(measurement));
}

Result<Outcome> Timings::outcome(const std::string& benchmark) const {
    if (!status_) return tl::unexpected(status_.error());
    Outcome outcome;
    Report rows = Report::array();
    for (const Measurement& measurement : measurements_) rows.push_back(rowOf(measurement));
    outcome.report = Report{{"name", benchmark}, {"rows", std::move(rows)}};
    return outcome;
}

}  // namespace hairloom::benchmarks
