// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Repeated measurements as three numbers, and the best of two costs.

#include <cstddef>
#include <utility>
#include <vector>

namespace hairloom {

struct Quartiles {
    double q1 = 0, median = 0, q3 = 0;
};
/// With linear interpolation between neighbours (Hyndman and Fan 1996, type 7). At least one value, all
/// finite.
Quartiles quartiles(std::vector<double> values);

/// Which of the (cost, error) pairs no other is better than: none has both numbers at most as large and one
/// of them smaller. Equal pairs stand or fall together; what is not finite never stands.
std::vector<bool> paretoFront(const std::vector<std::pair<double, double>>& pairs);

}  // namespace hairloom
