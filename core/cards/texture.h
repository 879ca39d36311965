// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Pictures that cards wear: what lies on a strip, seen straight on, texel by texel; and an atlas of them.

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/cards/hair_light.h"
#include "core/cards/strip.h"

namespace hairloom::cards {

/// A place of a card. All but coverage are means over what is covered; where nothing is, of what is near.
struct Texel {
    float coverage = 0;             ///< alpha, 0 … 1
    Vec3f albedo = Vec3f::Zero();   ///< linear RGB
    Vec2f flow = Vec2f(0, 1);       ///< of strands, root to tip: across and along the card; length ≤ 1
    Vec3f normal = Vec3f(0, 0, 1);  ///< of round strands: across, along, outwards
    float depth = 0;                ///< metres outwards from the flat strip or, on the cap, from the skin
    float along = 0;                ///< 0 root … 1 tip of the strand
    float id = 0;                   ///< 0 … 1, random by strand
    float open = 1;                 ///< ambient occlusion: share of the light that is left
};

struct Picture {
    std::uint32_t width = 0, height = 0;  ///< across and along the card; row 0 is the root
    std::vector<Texel> texels;
    const Texel& at(std::uint32_t x, std::uint32_t y) const { return texels[std::size_t{y} * width + x]; }
    Texel& at(std::uint32_t x, std::uint32_t y) { return texels[std::size_t{y} * width + x]; }
};

/// Metres of a hair, from its root, that the cap shows at most.
constexpr float kOnCap = 0.012f;

struct BakeOptions {
    float thickness = 1;  ///< factor on that of the strands
    /// Metres above the plane that touches the skin at its root from where on a strand is shown, at the
    /// latest behind kOnCap; some strands begin a little before, some behind. 0: from their roots on.
    float clear = 0;
    /// Where the points grew that were laid on the skin; light is what reaches them there. Empty: nothing
    /// was.
    std::span<const Vec3f> grown_ws = {};
};

/// Strands of the hair as they lie on a strip, each texel from 4 x 4 samples or more where strands are
/// thinner than these; what is outermost covers the rest.
Picture bake(const Hair& hair, const HairLight& light, const Strip& strip,
             std::span<const std::uint32_t> strands, const BakeOptions& options, std::uint32_t width,
             std::uint32_t height);

/// Half as wide and high, rounded up; means weighted by coverage.
Picture halved(const Picture& picture);

/// Texels without coverage take the means of the nearest that have some.
void fillGaps(Picture& picture);

/// Of a picture in an atlas, in texels.
struct Rect {
    std::uint32_t x = 0, y = 0, width = 0, height = 0;
};

struct Atlas {
    std::vector<Picture> levels;               ///< mip maps: the first is the atlas itself, the last 1 x 1
    std::vector<std::vector<float>> coverage;  ///< of the texels of each level, by itself
    std::vector<Rect> rects;                   ///< of each picture, in the first level
    float threshold =
        0.5f;  ///< alpha above which as many texels of the first level lie as its mean coverage says
    std::uint32_t side() const { return levels.empty() ? 0 : levels[0].width; }
};

/// Places of pictures of these sizes in a square, with `padding` texels around each; empty where they do not
/// fit.
std::vector<Rect> packed(std::span<const std::array<std::uint32_t, 2>> sizes, std::uint32_t side,
                         std::uint32_t padding);

/// Pictures at their rects, what lies between them filled, and mip maps.
Atlas makeAtlas(std::vector<Picture> pictures, std::vector<Rect> rects, std::uint32_t side);

/// What alpha of a mip map is to be multiplied with, so that of its texels as large a share lies above the
/// threshold as of the first level's.
float keepingScale(const Atlas& atlas, std::size_t level);

/// Bilinear within a rect of a level, u and v in [0, 1] of the rect.
Texel sample(const Atlas& atlas, const Rect& rect, std::size_t level, float u, float v);

/// Texels along one axis of a rect of a level.
class TexelAxis {
  public:
    TexelAxis(std::uint32_t first, std::uint32_t count, std::uint32_t size, std::size_t level);
    /// Texels on both sides of a place in [0, 1] of the rect; the share of the second.
    float place(float share, std::uint32_t& low, std::uint32_t& high) const {
        const float at =
            std::max(begin_ + std::clamp(share * length_, margin_, length_ - margin_) - 0.5f, 0.0f);
        const auto texel = static_cast<std::int32_t>(at);
        low = std::min(static_cast<std::uint32_t>(texel), size_ - 1);
        high = std::min(low + 1, size_ - 1);
        return at - static_cast<float>(texel);
    }

  private:
    float begin_, length_, margin_;
    std::uint32_t size_;
};

/// What sample() says of coverage alone, for many places of a rect of a level.
class CoverageSampler {
  public:
    CoverageSampler(const Atlas& atlas, const Rect& rect, std::size_t level);
    float at(float u, float v) const {
        std::uint32_t x0 = 0, x1 = 0, y0 = 0, y1 = 0;
        const float fx = x_.place(u, x0, x1), fy = y_.place(v, y0, y1);
        const float *const upper = &coverage_[y0 * width_], *const lower = &coverage_[y1 * width_];
        return (1 - fx) * (1 - fy) * upper[x0] + fx * (1 - fy) * upper[x1] + (1 - fx) * fy * lower[x0] +
               fx * fy * lower[x1];
    }
    /// No less than at() anywhere from one corner to the other.
    float most(const Vec2f& low, const Vec2f& high) const;

  private:
    const std::vector<float>& coverage_;
    std::size_t width_;
    TexelAxis x_, y_;
};

}  // namespace hairloom::cards
