// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/operations/curl_class.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/operations/stack_file.h"

namespace hairloom {
namespace {

constexpr float kPointsPerTurn = 8;
constexpr float kMostPoints = 1024;

// Wavelengths and diameters of curls are those that people measure with a ruler: waves of 5 cm, curls of
// 1.5 cm, coils of a few millimetres.
constexpr CurlClass kClasses[] = {
    {"straight", "falls without waves", R"({"operators": []})", 0},
    {"wavy", "flat waves of about 5 cm",
     R"({"operators": [
        {"op": "wave", "amplitude": 0.006, "frequency": 20, "start": 0.04, "turnDegrees": 20,
         "phaseVariation": 0.2, "amplitudeVariation": 0.4}]})",
     20},
    {"curly", "helices of about 1.5 cm, in wisps",
     R"({"operators": [
        {"op": "clump", "strength": 0.5},
        {"op": "curl", "radius": 0.0075, "frequency": 40, "start": 0.03, "phaseVariation": 0.25},
        {"op": "frizz", "angleDegrees": 10, "frequency": 60, "share": 0.4}]})",
     40},
    {"woolly", "tight coils of about 5 mm, each strand its own",
     R"({"operators": [
        {"op": "curl", "radius": 0.0025, "frequency": 120, "start": 0.01, "phaseVariation": 1},
        {"op": "frizz", "angleDegrees": 20, "frequency": 150, "share": 0.8}]})",
     120},
};

/// Apart from what they were numbered by.
bool isSame(const Operator& a, const Operator& b) {
    return a.op == b.op && a.settings == b.settings;
}

}  // namespace

std::span<const CurlClass> curlClasses() {
    return kClasses;
}

std::vector<std::string> curlNames() {
    std::vector<std::string> names;
    for (const CurlClass& one : kClasses) names.emplace_back(one.name);
    return names;
}

const CurlClass* findCurlClass(std::string_view name) {
    const auto* const found =
        std::ranges::find(kClasses, name, [](const CurlClass& one) { return std::string_view(one.name); });
    return found == std::end(kClasses) ? nullptr : found;
}

std::vector<Operator> operatorsOf(const CurlClass& curl) {
    auto operators = parseOperators(curl.name, curl.operators);
    assert(operators);
    return operators ? std::move(*operators) : std::vector<Operator>();
}

std::vector<Operator> withCurl(std::vector<Operator> stack, const CurlClass& curl) {
    for (const CurlClass& other : kClasses) {
        const std::vector<Operator> own = operatorsOf(other);
        if (own.empty()) continue;
        const auto at = std::search(stack.begin(), stack.end(), own.begin(), own.end(), isSame);
        if (at != stack.end()) stack.erase(at, at + static_cast<std::ptrdiff_t>(own.size()));
    }
    std::ranges::move(operatorsOf(curl), std::back_inserter(stack));
    return stack;
}

std::uint32_t pointsForCurl(const CurlClass& curl, float length) {
    const float points = std::ceil(kPointsPerTurn * curl.turnsPerMetre * length) + 1;
    return static_cast<std::uint32_t>(std::clamp(points, 2.0f, kMostPoints));
}

}  // namespace hairloom
