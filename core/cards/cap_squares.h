// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Squares of the plane of a chart of the cap, over which what is seen of the skin are means.

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/cards/cap.h"

namespace hairloom::cards {

class CapSquares {
  public:
    static constexpr float kSide = 0.004f;  // metres

    explicit CapSquares(const CapChart& chart)
        : across_(countOf(2 * chart.plane.halfWidth[0])),
          down_(countOf(chart.plane.length())),
          perPlane_(2 * chart.plane.halfWidth[0] / kSide, chart.plane.length() / kSide) {}
    int across() const { return across_; }
    int down() const { return down_; }
    std::size_t count() const { return static_cast<std::size_t>(across_) * static_cast<std::size_t>(down_); }
    /// A place in the chart's picture, 0 … 1, in squares.
    Vec2f of(const Vec2f& place) const { return place.cwiseProduct(perPlane_); }

    /// Calls f(square, weight) for the four whose middles are around a place.
    template <class F>
    void forNear(const Vec2f& at, const F& f) const {
        const float left = std::clamp(at.x() - 0.5f, 0.0f, static_cast<float>(across_ - 1));
        const float top = std::clamp(at.y() - 0.5f, 0.0f, static_cast<float>(down_ - 1));
        const int x0 = static_cast<int>(left), y0 = static_cast<int>(top);
        const int x1 = std::min(x0 + 1, across_ - 1), y1 = std::min(y0 + 1, down_ - 1);
        const float u = left - static_cast<float>(x0), v = top - static_cast<float>(y0);
        f(index(x0, y0), (1 - u) * (1 - v)), f(index(x1, y0), u * (1 - v));
        f(index(x0, y1), (1 - u) * v), f(index(x1, y1), u * v);
    }
    /// Of one value a square, between their middles.
    float between(const std::vector<float>& squares, const Vec2f& at) const {
        float sum = 0;
        forNear(at, [&](std::size_t square, float weight) { sum += weight * squares[square]; });
        return sum;
    }
    /// The place of a texel of the chart's picture, in squares.
    Vec2f ofTexel(std::uint32_t x, std::uint32_t y, std::uint32_t width, std::uint32_t height) const {
        return of(Vec2f((static_cast<float>(x) + 0.5f) / static_cast<float>(width),
                        (static_cast<float>(y) + 0.5f) / static_cast<float>(height)));
    }
    /// Means of coverageOf(x, y) of the texels of a picture of that size; 0 where a square has none.
    template <class CoverageOf>
    std::vector<float> means(std::uint32_t width, std::uint32_t height, const CoverageOf& coverageOf) const {
        std::vector<float> sums(count()), texels(count());
        for (std::uint32_t y = 0; y < height; ++y) {
            for (std::uint32_t x = 0; x < width; ++x) {
                const Vec2f at = ofTexel(x, y, width, height);
                const std::size_t square = index(std::min(static_cast<int>(at.x()), across_ - 1),
                                                 std::min(static_cast<int>(at.y()), down_ - 1));
                sums[square] += coverageOf(x, y), texels[square] += 1;
            }
        }
        for (std::size_t i = 0; i < sums.size(); ++i)
            if (texels[i] > 0) sums[i] /= texels[i];
        return sums;
    }

  private:
    static int countOf(float metres) { return std::max(1, static_cast<int>(std::ceil(metres / kSide))); }
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(across_) + static_cast<std::size_t>(x);
    }
    int across_, down_;
    Vec2f perPlane_;
};

}  // namespace hairloom::cards
