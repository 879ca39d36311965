// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/base/profiler.h"

#include <algorithm>
#include <map>
#include <mutex>

namespace hairloom::profiler {

struct Registry {
    std::mutex mutex;
    std::vector<Counter*> counters;

    static Registry& instance() {
        static Registry registry;
        return registry;
    }

    std::vector<Row> rows() {
        std::map<std::string, Row> byName;
        std::lock_guard lock(mutex);
        for (const Counter* counter : counters) {
            const std::uint64_t calls = counter->calls_.load(std::memory_order_relaxed);
            if (calls == 0) continue;
            Row& row = byName.try_emplace(counter->name_, Row{counter->name_, 0, 0.0}).first->second;
            row.calls += calls;
            row.milliseconds +=
                static_cast<double>(counter->nanoseconds_.load(std::memory_order_relaxed)) * 1e-6;
        }
        std::vector<Row> result;
        result.reserve(byName.size());
        for (auto& [name, row] : byName) result.push_back(std::move(row));
        return result;
    }

    void zero() {
        std::lock_guard lock(mutex);
        for (Counter* counter : counters) {
            counter->calls_.store(0, std::memory_order_relaxed);
            counter->nanoseconds_.store(0, std::memory_order_relaxed);
        }
    }
};

Counter::Counter(const char* name) : name_(name) {
    Registry& registry = Registry::instance();
    std::lock_guard lock(registry.mutex);
    registry.counters.push_back(this);
}

std::vector<Row> report() {
    std::vector<Row> rows = Registry::instance().rows();
    std::sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) {
        return a.milliseconds != b.milliseconds ? a.milliseconds > b.milliseconds : a.name < b.name;
    });
    return rows;
}

void reset() {
    Registry::instance().zero();
}

}  // namespace hairloom::profiler
