// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/length_unit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace hairloom {
namespace {

constexpr std::array<LengthUnit, 5> kUnits{
    {{"m", 1.0}, {"dm", 0.1}, {"cm", 0.01}, {"mm", 0.001}, {"inch", 0.0254}}};
constexpr double kSmallest = 0.12;
constexpr double kLargest = 2.6;
constexpr std::array<double, 2> kTypical{0.25, 1.75};  // a head, a standing human; metres

bool plausible(double metres) {
    return metres >= kSmallest && metres <= kLargest;
}

/// How far a size is from the nearest typical one, as the logarithm of their ratio.
double strangeness(double metres) {
    double minimum = std::abs(std::log(metres / kTypical[0]));
    for (const double typical : kTypical) minimum = std::min(minimum, std::abs(std::log(metres / typical)));
    return minimum;
}

}  // namespace

std::span<const LengthUnit> lengthUnits() {
    return kUnits;
}

const LengthUnit* fittingUnit(double size) {
    const LengthUnit* best = nullptr;
    for (const LengthUnit& unit : kUnits) {
        if (!plausible(size * unit.metres)) continue;
        if (!best || strangeness(size * unit.metres) < strangeness(size * best->metres)) best = &unit;
    }
    return best;
}

std::optional<std::string> implausibleSize(double size, double metresPerUnit) {
    const double metres = size * metresPerUnit;
    if (plausible(metres)) return std::nullopt;
    const LengthUnit* best = fittingUnit(size);
    const std::string found = fmt::format("is {:.3g} m large, an unlikely size for a head or a body", metres);
    if (!best) return found + ". No unit among m, dm, cm, mm and inch fits";
    return found + fmt::format(". With the unit {} it would be {:.3g} m", best->name, size * best->metres);
}

}  // namespace hairloom
