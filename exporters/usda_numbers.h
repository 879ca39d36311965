// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Arrays of numbers as USD's text has them.

#include <fmt/format.h>

#include <iterator>
#include <span>
#include <string>

#include "core/base/math.h"

namespace hairloom {

/// "[(1, 2, 3), …]", or "[1, 2, …]" of single numbers, as short as reads back to the same bits.
template <class T>
void writeNumbers(std::string& out, std::span<const T> numbers, std::size_t components) {
    const auto to = std::back_inserter(out);
    out += '[';
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        const std::size_t c = i % components;
        if (i > 0) out += ", ";
        if (components > 1 && c == 0) out += '(';
        fmt::format_to(to, "{}", numbers[i]);
        if (components > 1 && c + 1 == components) out += ')';
    }
    out += ']';
}

inline std::span<const float> numbersOf(std::span<const Vec3f> values) {
    return {values[0].data(), values.size() * 3};
}

}  // namespace hairloom
