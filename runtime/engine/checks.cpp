// SPDX-License-Identifier: MIT
#include "engine/checks.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

namespace hairloom::runtime {

std::string validationError(const SimulationSettings& settings) {
    std::string text;
    for (const std::string& problem : validate(settings)) text += (text.empty() ? "" : "\n") + problem;
    return text;
}

std::string validationError(const StrandsView& strands) {
    if (strands.offsets.empty()) return "no strand offsets; expected strand count + 1 of them";
    if (strands.offsets.front() != 0 || strands.offsets.back() != strands.restPositions_ss.size()) {
        return "strand offsets run from " + std::to_string(strands.offsets.front()) + " to " +
               std::to_string(strands.offsets.back()) + "; expected 0 to the number of points, " +
               std::to_string(strands.restPositions_ss.size());
    }
    const std::size_t count = strands.offsets.size() - 1;
    if (!strands.rootRotations_ss.empty() && strands.rootRotations_ss.size() != count) {
        return std::to_string(strands.rootRotations_ss.size()) + " root rotations for " +
               std::to_string(count) + " strands; expected none or one each";
    }
    for (std::size_t s = 0; s < count; ++s) {
        if (strands.offsets[s + 1] < strands.offsets[s] + 2 ||
            strands.offsets[s + 1] > strands.offsets[s] + kMaxPoints) {
            return "strand " + std::to_string(s) + " runs from point " + std::to_string(strands.offsets[s]) +
                   " to " + std::to_string(strands.offsets[s + 1]) + "; expected 2 to " +
                   std::to_string(kMaxPoints) + " points";
        }
        Quat rotation;
        if (!strands.rootRotations_ss.empty()) rotation = strands.rootRotations_ss[s];
        if (!normalize(rotation)) return "root rotation " + std::to_string(s) + " is not a rotation";
    }
    if (!strands.masses.empty() && strands.masses.size() != strands.restPositions_ss.size()) {
        return std::to_string(strands.masses.size()) + " masses for " +
               std::to_string(strands.restPositions_ss.size()) + " points; expected none or one each";
    }
    for (std::size_t p = 0; p < strands.masses.size(); ++p) {
        if (!(strands.masses[p] > 0.0f) || !std::isfinite(strands.masses[p]))
            return "mass of point " + std::to_string(p) + " is not a number above 0";
    }
    if (!strands.stiffness.empty() && strands.stiffness.size() != count) {
        return std::to_string(strands.stiffness.size()) + " values of stiffness for " +
               std::to_string(count) + " strands; expected none or one each";
    }
    std::string outside;
    for (std::size_t s = 0; s < strands.stiffness.size() && outside.empty(); ++s) {
        refuseOutside(outside, ("stiffness of strand " + std::to_string(s)).c_str(),
                      static_cast<double>(strands.stiffness[s]), 0.0, static_cast<double>(kMostStiffness));
    }
    if (!outside.empty()) return outside;
    for (std::size_t p = 0; p < strands.restPositions_ss.size(); ++p) {
        const Float3 at = strands.restPositions_ss[p];
        if (!isFinite(at) || std::max({std::abs(at.x), std::abs(at.y), std::abs(at.z)}) > kFarthest) {
            return "rest position of point " + std::to_string(p) + " is not a number within 1e6 m";
        }
    }
    return {};
}

void refuseOutside(std::string& text, const char* name, double value, double low, double high) {
    if (value >= low && value <= high) return;
    std::ostringstream line;
    line << (text.empty() ? "" : "\n") << name << " is " << value << "; expected " << low << " to " << high;
    text += line.str();
}

RootFrame between(const RootFrame& from, const RootFrame& to, float share) {
    const Quat a = from.rotation, b = to.rotation;
    const float other = a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w < 0.0f ? -share : share;
    const float rest = 1.0f - share;
    Quat mixed{rest * a.x + other * b.x, rest * a.y + other * b.y, rest * a.z + other * b.z,
               rest * a.w + other * b.w};
    if (!normalize(mixed)) mixed = b;
    return {from.position + (to.position - from.position) * share, mixed};
}

}  // namespace hairloom::runtime
