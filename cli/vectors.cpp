// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/vectors.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <vector>

namespace hairloom::cli {
namespace {

/// The numbers of a text that separates them by `separator`; empty where it holds anything else.
template <class T>
std::vector<T> numbers(const std::string& text, char separator) {
    std::vector<T> values;
    const char* at = text.data();
    const char* const end = at + text.size();
    while (true) {
        T value{};
        const auto [next, code] = std::from_chars(at, end, value);
        if (code != std::errc()) return {};
        values.push_back(value);
        if (next == end) return values;
        if (*next != separator) return {};
        at = next + 1;
    }
}

}  // namespace

Result<Vec3f> parseVector(const std::string& text, const std::string& option) {
    const auto values = numbers<float>(text, ',');
    if (values.size() != 3 || !Vec3f(values[0], values[1], values[2]).allFinite()) {
        return fail(fmt::format("{} is '{}'", option, text), "expected three numbers X,Y,Z");
    }
    return Vec3f(values[0], values[1], values[2]);
}

Result<std::pair<std::uint32_t, std::uint32_t>> parseSize(const std::string& text) {
    constexpr std::uint32_t kLargest = 16384;
    const auto values = numbers<std::uint32_t>(text, 'x');
    if (values.size() != 2 || values[0] == 0 || values[1] == 0 || values[0] > kLargest ||
        values[1] > kLargest) {
        return fail(fmt::format("--size is '{}'", text),
                    fmt::format("expected WxH, each from 1 to {}", kLargest));
    }
    return std::pair(values[0], values[1]);
}

}  // namespace hairloom::cli
