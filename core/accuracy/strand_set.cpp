// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/accuracy/strand_set.h"

#include <cmath>

namespace hairloom {

using runtime::Float3;
using runtime::Quat;

void StrandSet::add(const std::vector<Float3>& strand) {
    points.insert(points.end(), strand.begin(), strand.end());
    offsets.push_back(static_cast<std::uint32_t>(points.size()));
}

void StrandSet::addStraight(Float3 root, Float3 direction, float segment, std::uint32_t count) {
    std::vector<Float3> strand;
    for (std::uint32_t p = 0; p < count; ++p)
        strand.push_back(root + direction * (segment * static_cast<float>(p)));
    add(strand);
}

std::vector<runtime::RootFrame> StrandSet::roots(Float3 shift, Quat turn) const {
    std::vector<runtime::RootFrame> result;
    for (std::uint32_t s = 0; s < count(); ++s)
        result.push_back({rotate(turn, points[offsets[s]]) + shift, turn});
    return result;
}

Float3 hangingAt(float angle) {
    return {std::sin(angle), -std::cos(angle), 0.0f};
}

Quat turnAboutY(float angle) {
    return {0.0f, std::sin(0.5f * angle), 0.0f, std::cos(0.5f * angle)};
}

StrandSet tuft(std::uint32_t points, float segment) {
    StrandSet strands;
    for (std::uint32_t s = 0; s < 8; ++s) {
        const float f = static_cast<float>(s);
        const float around = 0.7f * f;
        const Float3 out{std::sin(around), 0.0f, std::cos(around)};
        const float angle = 0.1f + 0.2f * f;  // from straight down
        const Float3 direction = out * std::sin(angle) + Float3{0.0f, -std::cos(angle), 0.0f};
        strands.addStraight(Float3{0.0f, 0.1f, 0.0f} + out * 0.02f, direction, segment, points);
    }
    return strands;
}

}  // namespace hairloom
