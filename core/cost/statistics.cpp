// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/cost/statistics.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

namespace hairloom {
namespace {

double quantile(const std::vector<double>& sorted, double share) {
    const double at = share * static_cast<double>(sorted.size() - 1);
    const auto below = static_cast<std::size_t>(at);
    const std::size_t above = std::min(below + 1, sorted.size() - 1);
    return sorted[below] + (at - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

}  // namespace

Quartiles quartiles(std::vector<double> values) {
    assert(!values.empty());
    std::ranges::sort(values);
    return {quantile(values, 0.25), quantile(values, 0.5), quantile(values, 0.75)};
}

std::vector<bool> paretoFront(const std::vector<std::pair<double, double>>& pairs) {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        if (std::isfinite(pairs[i].first) && std::isfinite(pairs[i].second)) order.push_back(i);
    }
    std::ranges::sort(order, [&](std::size_t a, std::size_t b) { return pairs[a] < pairs[b]; });
    std::vector<bool> front(pairs.size(), false);
    const std::pair<double, double>* last = nullptr;
    for (const std::size_t i : order) {
        // In order of cost, only a smaller error than any before adds to the front; equal pairs follow one
        // another.
        if (last && pairs[i].second >= last->second && pairs[i] != *last) continue;
        front[i] = true;
        last = &pairs[i];
    }
    return front;
}

}  // namespace hairloom
