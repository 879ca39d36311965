// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "core/cards/judge.h"
#include "core/render/flip.h"
#include "core/render/tone_map.h"

namespace hairloom::cards {
namespace {

/// Area between the outlines, and the length of the first.
struct Outline {
    double between = 0, length = 0;
};
Outline outline(const Shot& a, const Shot& b) {
    Outline result;
    const auto inside = [](const Shot& shot, std::uint32_t x, std::uint32_t y) {
        return shot.coverage[std::size_t{y} * shot.width + x] >= 0.5f;
    };
    for (std::uint32_t y = 0; y < a.height; ++y) {
        for (std::uint32_t x = 0; x < a.width; ++x) {
            const bool in = inside(a, x, y);
            if (in != inside(b, x, y)) result.between += 1;
            if (x + 1 < a.width && in != inside(a, x + 1, y)) result.length += 1;
            if (y + 1 < a.height && in != inside(a, x, y + 1)) result.length += 1;
        }
    }
    return result;
}

}  // namespace

double hairLuminance(std::span<const Shot> shots) {
    double sum = 0;
    for (const Shot& shot : shots)
        for (const Vec3f& rgb : shot.hair) sum += static_cast<double>(luminance(rgb));
    return sum;
}

render::Image shownAs(const Shot& shot) {
    render::LinearImage linear{shot.width, shot.height, {}};
    for (const Vec3f& light : shot.all)
        for (const float value : {light.x(), light.y(), light.z(), 1.0f}) linear.rgba.push_back(value);
    constexpr float kExposure = 2;
    return render::toneMap(linear, kExposure);
}

Shares sharesOf(std::span<const Shot> strands, std::span<const Shot> level) {
    double covered = 0, wanted = 0;
    for (const Shot& shot : strands)
        for (const float share : shot.coverage) wanted += static_cast<double>(share);
    for (const Shot& shot : level)
        for (const float share : shot.coverage) covered += static_cast<double>(share);
    const double light = hairLuminance(strands);
    return {wanted > 0 ? covered / wanted : 1, light > 0 ? hairLuminance(level) / light : 1};
}

Result<Difference> difference(std::span<const Shot> strands, std::span<const Shot> level) {
    Difference result;
    Outline outlines;
    for (std::size_t i = 0; i < strands.size(); ++i) {
        const Shot &a = strands[i], &b = level[i];
        const auto flip = render::flipDifference(shownAs(a), shownAs(b));
        if (!flip) return tl::unexpected(flip.error());
        result.flip += flip->mean / static_cast<double>(strands.size());
        result.worstFlip = std::max(result.worstFlip, flip->mean);
        const Outline one = outline(a, b);
        outlines.between += one.between, outlines.length += one.length;
    }
    const Shares shares = sharesOf(strands, level);
    result.coverage = shares.coverage, result.light = shares.light;
    result.silhouettePx = outlines.length > 0 ? outlines.between / outlines.length : 0;
    return result;
}

}  // namespace hairloom::cards
