// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/base/processor_watch.h"

#include <algorithm>
#include <fstream>
#include <string>

#ifdef __linux__
#include <sys/resource.h>
#include <unistd.h>
#endif

namespace hairloom {

ProcessorWatch::ProcessorWatch() : begin_(now()) {}

std::optional<ProcessorWatch::Times> ProcessorWatch::now() {
#ifdef __linux__
    // "cpu user nice system idle iowait irq softirq steal …", in ticks.
    std::ifstream file("/proc/stat");
    std::string name;
    Times times;
    if (!(file >> name) || name != "cpu") return std::nullopt;
    constexpr int kColumns = 8, kIdle = 3, kWait = 4;
    const auto tick = 1 / static_cast<double>(sysconf(_SC_CLK_TCK));
    for (int column = 0; column < kColumns; ++column) {
        double ticks = 0;
        if (!(file >> ticks)) return std::nullopt;
        times.all += ticks * tick;
        if (column != kIdle && column != kWait) times.busy += ticks * tick;
    }
    for (const int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
        rusage used{};
        if (getrusage(who, &used) != 0) return std::nullopt;
        for (const timeval& part : {used.ru_utime, used.ru_stime})
            times.own += static_cast<double>(part.tv_sec) + 1e-6 * static_cast<double>(part.tv_usec);
    }
    return times;
#else
    return std::nullopt;
#endif
}

std::optional<double> ProcessorWatch::othersShare() const {
    constexpr double kShortest = 0.2;  // seconds of one processor
    const auto end = now();
    if (!begin_ || !end || end->all - begin_->all < kShortest) return std::nullopt;
    const double others = (end->busy - begin_->busy) - (end->own - begin_->own);
    return std::clamp(others / (end->all - begin_->all), 0.0, 1.0);
}

}  // namespace hairloom
