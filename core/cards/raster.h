// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Which samples of a picture lines and triangles cover. Sample (x, y) lies at (x + 0.5, y + 0.5); borders
// belong to one of two neighbours.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "core/base/math.h"

namespace hairloom::cards {

/// What a random number of three integers is: 0 … 1, the same everywhere.
inline float hashUnit(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    std::uint32_t h = a * 0x9e3779b9u ^ (b * 0x85ebca6bu + 0x7f4a7c15u) ^ (c * 0xc2b2ae35u + 0x165667b1u);
    h ^= h >> 16u, h *= 0x7feb352du, h ^= h >> 15u, h *= 0x846ca68bu, h ^= h >> 16u;
    return static_cast<float>(h >> 8u) * 0x1p-24f;
}

/// A point of a line on a picture, in samples. Radii may differ by axis, where the picture is stretched.
struct LinePoint {
    Vec2f at;
    Vec2f radius;
};

/// Rows [first, end) of a picture.
struct Rows {
    int first, end;
};

/// Calls f(x, y, t) for the samples of a line of round cross-section, t in [0, 1] from a to b. A line thinner
/// than a sample covers as many of them as its area says. In some rows of a picture it has the samples that
/// it has there in all of them.
template <class F>
void forSamplesOfLine(const LinePoint& a, const LinePoint& b, int width, Rows rows, const F& f) {
    const Vec2f d = b.at - a.at;
    const int major = std::abs(d.y()) * a.radius.x() >= std::abs(d.x()) * a.radius.y() ? 1 : 0;
    const int minor = 1 - major;
    if (d[major] == 0) return;
    const float low = std::min(a.at[major], b.at[major]), high = std::max(a.at[major], b.at[major]);
    const int from[2] = {0, rows.first}, to[2] = {width, rows.end};
    const int begin = std::max(from[major], static_cast<int>(std::ceil(std::max(low, -1.0f) - 0.5f)));
    const int end = std::min(to[major], static_cast<int>(std::ceil(std::min(high, 1e6f) - 0.5f)));
    const float slope = (d[minor] * a.radius[major]) / (d[major] * a.radius[minor]);
    const float wider = std::sqrt(1 + slope * slope);
    for (int i = begin; i < end; ++i) {
        const float t = std::clamp((static_cast<float>(i) + 0.5f - a.at[major]) / d[major], 0.0f, 1.0f);
        const float middle = a.at[minor] + t * d[minor];
        const float half = wider * (a.radius[minor] + t * (b.radius[minor] - a.radius[minor]));
        const int first =
            std::max(from[minor], static_cast<int>(std::ceil(std::max(middle - half, -1.0f) - 0.5f)));
        const int last =
            std::min(to[minor], static_cast<int>(std::ceil(std::min(middle + half, 1e6f) - 0.5f)));
        for (int j = first; j < last; ++j) major == 1 ? f(j, i, t) : f(i, j, t);
    }
}

/// Rows outside of which the line has no sample.
inline Rows rowsOfLine(const LinePoint& a, const LinePoint& b, int height) {
    // A line that lies flat is wider by at most the square root of two: its slope is 1 at most.
    const float wide = 1.5f * std::max(a.radius.maxCoeff(), b.radius.maxCoeff()) + 1;
    const float low = std::min(a.at.y(), b.at.y()) - wide, high = std::max(a.at.y(), b.at.y()) + wide;
    const auto row = [&](float y) {
        return static_cast<int>(std::max(0.0f, std::min(static_cast<float>(height), y)));
    };
    return {row(low), row(high + 1)};
}

/// Of a row of samples those that may lie in the triangle: where no barycentric is clearly below 0.
inline std::pair<int, int> spanOfRow(const Vec2f& a, const Vec2f& b, const Vec2f& c, float area,
                                     const Vec3f& growth, float y, int x0, int x1) {
    constexpr float kRounding = 1e-3f;
    const Vec2f p(static_cast<float>(x0) + 0.5f, y);
    const float u = ((b - p).x() * (c - p).y() - (b - p).y() * (c - p).x()) / area;
    const float v = ((c - p).x() * (a - p).y() - (c - p).y() * (a - p).x()) / area;
    const Vec3f at = Vec3f(u, v, 1 - u - v) + Vec3f::Constant(kRounding);
    float low = 0, high = static_cast<float>(x1 - x0);
    for (int i = 0; i < 3; ++i) {
        if (growth[i] > 0) low = std::max(low, -at[i] / growth[i] - 1);
        if (growth[i] < 0) high = std::min(high, at[i] / -growth[i] + 2);
        if (growth[i] == 0 && at[i] < 0) return {x0, x0};
    }
    return low < high ? std::pair(x0 + static_cast<int>(low), x0 + static_cast<int>(high))
                      : std::pair(x0, x0);
}

/// Samples of a row that share an instruction, and one barycentric of each.
inline constexpr int kSamplesAtOnce = 4;
using SampleRow = Eigen::Array4f;

/// Of those the ones outside of which the triangle has no sample; none where first ≥ end.
inline Rows rowsOfTriangle(const Vec2f& a, const Vec2f& b, const Vec2f& c, Rows rows) {
    const float low = std::min({a.y(), b.y(), c.y()}), high = std::max({a.y(), b.y(), c.y()});
    return {std::max(rows.first, static_cast<int>(std::floor(std::clamp(low, 0.0f, 1e6f)))),
            std::min(rows.end, static_cast<int>(std::ceil(std::clamp(high, -1.0f, 1e6f))))};
}

/// Calls f(x, y, barycentrics) for the samples of a triangle of either orientation. Of kSamplesAtOnce that
/// begin at x, isHidden(x, y) may say that none is wanted, and isHidden(x, y, u, v, w) with their
/// barycentrics; they may go beyond the triangle and the row. In some rows of a picture it has the samples
/// that it has there in all of them.
template <class F, class Hidden>
void forSamplesOfTriangle(const Vec2f& a, const Vec2f& b, const Vec2f& c, int width, Rows rows, const F& f,
                          const Hidden& isHidden) {
    const float area = (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
    if (area == 0 || !std::isfinite(area)) return;
    const Vec2f low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
    const int x0 = std::max(0, static_cast<int>(std::floor(std::max(low.x(), 0.0f))));
    const int x1 = std::min(width, static_cast<int>(std::ceil(std::min(high.x(), 1e6f))));
    // A barycentric grows by so much from one sample of a row to the next.
    const Vec3f growth = Vec3f(b.y() - c.y(), c.y() - a.y(), a.y() - b.y()) / area;
    const Rows touched = rowsOfTriangle(a, b, c, rows);
    for (int y = touched.first; y < touched.end; ++y) {
        const auto [begin, end] = spanOfRow(a, b, c, area, growth, static_cast<float>(y) + 0.5f, x0, x1);
        const float py = static_cast<float>(y) + 0.5f;
        const float ay = a.y() - py, by = b.y() - py, cy = c.y() - py;
        const SampleRow places(0, 1, 2, 3);
        for (int x = begin; x < end; x += kSamplesAtOnce) {
            if (isHidden(x, y)) continue;
            const SampleRow px = (static_cast<float>(x) + places) + 0.5f;
            const SampleRow u = ((b.x() - px) * cy - by * (c.x() - px)) / area;
            const SampleRow v = ((c.x() - px) * ay - cy * (a.x() - px)) / area;
            const SampleRow w = 1 - u - v;
            if (isHidden(x, y, u, v, w)) continue;
            for (int i = 0; i < std::min(kSamplesAtOnce, end - x); ++i)
                if (u[i] >= 0 && v[i] >= 0 && w[i] > 0) f(x + i, y, Vec3f(u[i], v[i], w[i]));
        }
    }
}

/// Where all samples of a triangle are wanted.
struct NothingHidden {
    bool operator()(int, int) const { return false; }
    bool operator()(int, int, const SampleRow&, const SampleRow&, const SampleRow&) const { return false; }
};

template <class F>
void forSamplesOfTriangle(const Vec2f& a, const Vec2f& b, const Vec2f& c, int width, int height, const F& f) {
    forSamplesOfTriangle(a, b, c, width, {0, height}, f, NothingHidden());
}

}  // namespace hairloom::cards
