// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/brush_curve.h"

#include <array>
#include <cmath>
#include <string_view>

namespace hairloom::editing {
namespace {

constexpr std::array<std::string_view, 5> kNames = {"constant", "linear", "smooth", "sharp", "round"};
constexpr std::size_t kSamples = 33;

float valueAt(std::string_view name, float x) {
    if (name == "smooth") return 1 - x * x * (3 - 2 * x);
    if (name == "sharp") return (1 - x) * (1 - x);
    return std::sqrt(1 - x * x);
}

}  // namespace

std::span<const std::string_view> BrushCurve::falloffNames() {
    return kNames;
}

BrushCurve BrushCurve::falloff(std::string_view name) {
    if (name == "linear") return BrushCurve({1, 0});
    if (name != "smooth" && name != "sharp" && name != "round") return {};
    std::vector<float> values(kSamples);
    for (std::size_t i = 0; i < kSamples; ++i)
        values[i] = valueAt(name, static_cast<float>(i) / static_cast<float>(kSamples - 1));
    return BrushCurve(std::move(values));
}

}  // namespace hairloom::editing
