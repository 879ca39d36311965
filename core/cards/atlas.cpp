// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>

#include "core/cards/texture.h"

namespace hairloom::cards {

namespace {

/// How high a square is filled, from its left to its right (Jylänki 2010, the skyline).
class Skyline {
  public:
    explicit Skyline(std::uint32_t side) : side_(side) {}

    /// Puts a rectangle where it lies lowest, at the left of such places. Nothing where it does not fit.
    std::optional<std::array<std::uint32_t, 2>> put(std::uint32_t width, std::uint32_t height) {
        std::optional<std::array<std::uint32_t, 2>> best;
        for (std::size_t i = 0; i < steps_.size() && steps_[i].x + width <= side_; ++i) {
            std::uint32_t top = 0;
            for (std::size_t k = i; k < steps_.size() && steps_[k].x < steps_[i].x + width; ++k)
                top = std::max(top, steps_[k].y);
            if (top + height <= side_ && (!best || top < (*best)[1])) best = {steps_[i].x, top};
        }
        if (best) raise((*best)[0], (*best)[0] + width, (*best)[1] + height);
        return best;
    }

  private:
    struct Step {
        std::uint32_t x, y;  ///< so high from here to the next
    };
    void raise(std::uint32_t begin, std::uint32_t end, std::uint32_t y) {
        std::vector<Step> steps;
        std::uint32_t behind = 0;
        for (const Step& step : steps_) {
            if (step.x < begin) steps.push_back(step);
            if (step.x <= end) behind = step.y;
        }
        steps.push_back({begin, y});
        if (end < side_) steps.push_back({end, behind});
        for (const Step& step : steps_)
            if (step.x > end) steps.push_back(step);
        steps_ = std::move(steps);
    }
    std::uint32_t side_;
    std::vector<Step> steps_{{0, 0}};
};

}  // namespace

std::vector<Rect> packed(std::span<const std::array<std::uint32_t, 2>> sizes, std::uint32_t side,
                         std::uint32_t padding) {
    std::vector<std::size_t> order(sizes.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return sizes[a][1] > sizes[b][1]; });
    std::vector<Rect> rects(sizes.size());
    Skyline skyline(side);
    for (const std::size_t i : order) {
        const auto at = skyline.put(sizes[i][0] + 2 * padding, sizes[i][1] + 2 * padding);
        if (!at) return {};
        rects[i] = {(*at)[0] + padding, (*at)[1] + padding, sizes[i][0], sizes[i][1]};
    }
    return rects;
}

namespace {

double meanCoverage(const Picture& picture, const std::vector<Rect>& rects) {
    double sum = 0, texels = 0;
    for (const Rect& rect : rects) {
        for (std::uint32_t y = rect.y; y < rect.y + rect.height; ++y)
            for (std::uint32_t x = rect.x; x < rect.x + rect.width; ++x)
                sum += static_cast<double>(picture.at(x, y).coverage);
        texels += static_cast<double>(rect.width) * static_cast<double>(rect.height);
    }
    return texels > 0 ? sum / texels : 0;
}

/// The value that a share of the texels of a picture lies above.
float valueAbove(const Picture& picture, double share) {
    std::vector<float> values;
    values.reserve(picture.texels.size());
    for (const Texel& t : picture.texels) values.push_back(t.coverage);
    const auto at =
        std::min(values.size() - 1, static_cast<std::size_t>(share * static_cast<double>(values.size())));
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end(),
                     std::greater<>());
    return values[at];
}

double shareAbove(const Picture& picture, float threshold) {
    const auto count =
        std::ranges::count_if(picture.texels, [&](const Texel& t) { return t.coverage >= threshold; });
    return static_cast<double>(count) / static_cast<double>(picture.texels.size());
}

}  // namespace

Atlas makeAtlas(std::vector<Picture> pictures, std::vector<Rect> rects, std::uint32_t side) {
    Atlas atlas;
    Picture whole{side, side, std::vector<Texel>(std::size_t{side} * side)};
    for (std::size_t i = 0; i < pictures.size(); ++i) {
        for (std::uint32_t y = 0; y < rects[i].height; ++y) {
            for (std::uint32_t x = 0; x < rects[i].width; ++x)
                whole.at(rects[i].x + x, rects[i].y + y) = pictures[i].at(x, y);
        }
    }
    fillGaps(whole);
    const double covered = meanCoverage(whole, rects);
    double all = 0;
    for (const Rect& rect : rects) all += static_cast<double>(rect.width) * static_cast<double>(rect.height);
    const double share = covered * all / (static_cast<double>(side) * static_cast<double>(side));
    atlas.threshold = std::clamp(valueAbove(whole, share), 0.05f, 0.95f);
    atlas.rects = std::move(rects);
    atlas.levels.push_back(std::move(whole));
    while (atlas.levels.back().width > 1) atlas.levels.push_back(halved(atlas.levels.back()));
    for (const Picture& level : atlas.levels) {
        std::vector<float>& coverage = atlas.coverage.emplace_back();
        coverage.reserve(level.texels.size());
        for (const Texel& t : level.texels) coverage.push_back(t.coverage);
    }
    return atlas;
}

float keepingScale(const Atlas& atlas, std::size_t level) {
    const double share = shareAbove(atlas.levels[0], atlas.threshold);
    const float value = valueAbove(atlas.levels[level], share);
    return value > 0 ? atlas.threshold / value : 1.0f;
}

namespace {

/// Bilinear taps within a rect: four texels with their weights.
struct Taps {
    std::array<std::size_t, 4> at;
    std::array<float, 4> weight;
};
Taps taps(const Picture& picture, const Rect& rect, std::size_t level, float u, float v) {
    std::uint32_t x0 = 0, x1 = 0, y0 = 0, y1 = 0;
    const float fx = TexelAxis(rect.x, rect.width, picture.width, level).place(u, x0, x1);
    const float fy = TexelAxis(rect.y, rect.height, picture.height, level).place(v, y0, y1);
    const auto index = [&](std::uint32_t x, std::uint32_t y) { return std::size_t{y} * picture.width + x; };
    return {{index(x0, y0), index(x1, y0), index(x0, y1), index(x1, y1)},
            {(1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy, fx * fy}};
}

}  // namespace

TexelAxis::TexelAxis(std::uint32_t first, std::uint32_t count, std::uint32_t size, std::size_t level)
    : size_(size) {
    const float scale = 1.0f / static_cast<float>(1u << level);
    begin_ = static_cast<float>(first) * scale, length_ = static_cast<float>(count) * scale;
    // No nearer to the border than half a texel, where there is room for that.
    margin_ = std::min(0.5f, 0.5f * length_);
}

CoverageSampler::CoverageSampler(const Atlas& atlas, const Rect& rect, std::size_t level)
    : coverage_(atlas.coverage[level]),
      width_(atlas.levels[level].width),
      x_(rect.x, rect.width, atlas.levels[level].width, level),
      y_(rect.y, rect.height, atlas.levels[level].height, level) {}

float CoverageSampler::most(const Vec2f& low, const Vec2f& high) const {
    std::uint32_t left = 0, right = 0, top = 0, bottom = 0, between = 0;
    x_.place(low.x(), left, between), x_.place(high.x(), between, right);
    y_.place(low.y(), top, between), y_.place(high.y(), between, bottom);
    // Places are rounded: the next texel may have a say, and weights sum up to a little more than 1.
    constexpr float kRounding = 1.00001f;
    const auto last = static_cast<std::uint32_t>(width_ - 1);  // atlases are squares
    float most = 0;
    for (std::size_t y = top - std::min(top, 1u); y <= std::min(bottom + 1, last); ++y) {
        const float* const row = &coverage_[y * width_];
        for (std::uint32_t x = left - std::min(left, 1u); x <= std::min(right + 1, last); ++x)
            most = std::max(most, row[x]);
    }
    return kRounding * most;
}

Texel sample(const Atlas& atlas, const Rect& rect, std::size_t level, float u, float v) {
    const Picture& picture = atlas.levels[level];
    const Taps t = taps(picture, rect, level, u, v);
    Texel out;
    out.flow.setZero(), out.normal.setZero(), out.open = 0;
    for (std::size_t k = 0; k < 4; ++k) {
        const Texel& in = picture.texels[t.at[k]];
        const float w = t.weight[k];
        out.coverage += w * in.coverage, out.albedo += w * in.albedo, out.flow += w * in.flow;
        out.normal += w * in.normal, out.depth += w * in.depth, out.along += w * in.along;
        out.id += w * in.id, out.open += w * in.open;
    }
    return out;
}

}  // namespace hairloom::cards
