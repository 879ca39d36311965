// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/cards/cap_squares.h"
#include "core/cards/raster.h"

namespace hairloom::cards {
namespace {

constexpr float kSample = 0.001f;  // metres: what of cards is looked at
constexpr int kFiner = 4;          // samples of strands along one of cards
constexpr int kSquare = 4;         // samples along a square of CapSquares
static_assert(kSquare * kSample == CapSquares::kSide);
constexpr float kBelow = 0.004f, kNear = 0.02f;  // metres below and above the skin: hair that grows there
// Few eyes look straight on. Aslant, hair hides more skin, as more layers of it do, and cards part where it
// does not: where hair is dense it hides as so many layers more, where it is sparse as itself.
constexpr float kLayers = 2;

/// The plane of a chart by samples, and how high the skin is there.
class Ground {
  public:
    explicit Ground(const CapChart& chart)
        : across_(chart.plane.cross[0]),
          along_(chart.plane.along[0]),
          outwards_(chart.plane.normal[0]),
          corner_(chart.plane.centre[0] - chart.plane.halfWidth[0] * across_) {
        const CapSquares squares(chart);
        columns_ = squares.across() * kSquare, rows_ = squares.down() * kSquare;
        heights_.assign(samples(), -std::numeric_limits<float>::infinity());
        for (std::size_t i = 0; i + 2 < chart.indices.size(); i += 3) {
            std::array<Vec3f, 3> at;
            for (std::size_t k = 0; k < 3; ++k) at[k] = of(chart.vertices[chart.indices[i + k]].position_ws);
            forSamplesOfTriangle(at[0].head<2>(), at[1].head<2>(), at[2].head<2>(), columns_, rows_,
                                 [&](int x, int y, const Vec3f& w) {
                                     float& height = heights_[index(x, y)];
                                     height = std::max(height, w.dot(Vec3f(at[0].z(), at[1].z(), at[2].z())));
                                 });
        }
    }
    int columns() const { return columns_; }
    int rows() const { return rows_; }
    std::size_t samples() const {
        return static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
    }
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(x);
    }
    /// In samples, and metres outwards.
    Vec3f of(const Vec3f& point_ws) const {
        const Vec3f d = point_ws - corner_;
        return {d.dot(across_) / kSample, d.dot(along_) / kSample, d.dot(outwards_)};
    }
    bool isNear(std::size_t sample, float height) const {
        const float above = height - heights_[sample];
        return above > -kBelow && above < kNear;
    }
    /// Means of what samples with skin have, by squares; 0 where there is none.
    template <class Of>
    std::vector<float> means(const Of& of) const {
        const int across = columns_ / kSquare;
        std::vector<float> sums(samples() / (kSquare * kSquare)), counts(sums.size());
        for (int y = 0; y < rows_; ++y) {
            for (int x = 0; x < columns_; ++x) {
                if (!std::isfinite(heights_[index(x, y)])) continue;
                const auto square = static_cast<std::size_t>(y / kSquare * across + x / kSquare);
                sums[square] += of(index(x, y)), counts[square] += 1;
            }
        }
        for (std::size_t i = 0; i < sums.size(); ++i)
            if (counts[i] > 0) sums[i] /= counts[i];
        return sums;
    }

  private:
    Vec3f across_, along_, outwards_, corner_;
    int columns_, rows_;
    std::vector<float> heights_;
};

/// Texels of a chart as `wanted`, one a square, has them on average: thinner by a factor, denser as more
/// layers of the same hair would be.
void setMeans(const CapChart& chart, const std::vector<float>& wanted, Picture& picture) {
    constexpr float kMostLayers = 8, kLeast = 1e-4f;
    const CapSquares squares(chart);
    std::vector<float> thinner =
        squares.means(picture.width, picture.height,
                      [&](std::uint32_t x, std::uint32_t y) { return picture.at(x, y).coverage; });
    std::vector<float> layers(thinner.size(), 1);
    for (std::size_t i = 0; i < thinner.size(); ++i) {
        const float own = thinner[i];
        thinner[i] = own > kLeast ? std::min(1.0f, wanted[i] / own) : 1.0f;
        if (own > kLeast && own < 1 && wanted[i] > own)
            layers[i] = std::min(kMostLayers, std::log1p(-std::min(wanted[i], 0.99f)) / std::log1p(-own));
    }
    for (std::uint32_t y = 0; y < picture.height; ++y) {
        for (std::uint32_t x = 0; x < picture.width; ++x) {
            const Vec2f at = squares.ofTexel(x, y, picture.width, picture.height);
            float& coverage = picture.at(x, y).coverage;
            coverage = 1 - std::pow(1 - squares.between(thinner, at) * coverage, squares.between(layers, at));
        }
    }
}

}  // namespace

void setHidden(const Hair& hair, CapChart& chart) {
    const Ground ground(chart);
    const int columns = ground.columns() * kFiner, rows = ground.rows() * kFiner;
    std::vector<std::uint8_t> isHidden(ground.samples() * kFiner * kFiner, 0);
    const auto fine = [&](int x, int y) {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(x);
    };
    constexpr float kPerMetre = static_cast<float>(kFiner) / kSample;
    for (std::size_t s = 0; s < hair.strandCount(); ++s) {
        for (std::size_t p = hair.offsets[s]; p + 1 < hair.offsets[s + 1]; ++p) {
            const Vec3f a = ground.of(hair.positions_ws[p]), b = ground.of(hair.positions_ws[p + 1]);
            const auto end = [&](const Vec3f& at, std::size_t point) {
                return LinePoint{static_cast<float>(kFiner) * at.head<2>(),
                                 Vec2f::Constant(std::max(1e-4f, kPerMetre * hair.radii[point]))};
            };
            forSamplesOfLine(end(a, p), end(b, p + 1), columns, {0, rows}, [&](int x, int y, float t) {
                if (ground.isNear(ground.index(x / kFiner, y / kFiner), a.z() + t * (b.z() - a.z())))
                    isHidden[fine(x, y)] = 1;
            });
        }
    }
    std::vector<float> shares(ground.samples());
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x)
            shares[ground.index(x / kFiner, y / kFiner)] +=
                static_cast<float>(isHidden[fine(x, y)]) / (kFiner * kFiner);
    chart.hidden = ground.means([&](std::size_t sample) { return shares[sample]; });
}

void leaveToCards(std::span<const WornTriangle> cards, const CapChart& chart, Picture& picture) {
    if (!chart.wanted.empty()) {
        setMeans(chart, chart.wanted, picture);
        return;
    }
    const Ground ground(chart);
    std::vector<float> open(ground.samples(), 1);  // what cards leave of the skin
    for (const WornTriangle& t : cards) {
        const Vec3f a = ground.of(t.at_ws[0]), b = ground.of(t.at_ws[1]), c = ground.of(t.at_ws[2]);
        forSamplesOfTriangle(
            a.head<2>(), b.head<2>(), c.head<2>(), ground.columns(), ground.rows(),
            [&](int x, int y, const Vec3f& w) {
                const std::size_t sample = ground.index(x, y);
                if (!ground.isNear(sample, w.dot(Vec3f(a.z(), b.z(), c.z())))) return;
                const Vec2f place = w.x() * t.place[0] + w.y() * t.place[1] + w.z() * t.place[2];
                const auto texel = [](float share, std::uint32_t size) {
                    const float at = std::clamp(share, 0.0f, 1.0f) * static_cast<float>(size);
                    return std::min(static_cast<std::uint32_t>(at), size - 1);
                };
                open[sample] -=
                    open[sample] *
                    t.picture->at(texel(place.x(), t.picture->width), texel(place.y(), t.picture->height))
                        .coverage;
            });
    }
    std::vector<float> keep = ground.means([&](std::size_t sample) { return open[sample]; });
    const CapSquares squares(chart);
    // What the cap covers by itself.
    const std::vector<float> own =
        squares.means(picture.width, picture.height,
                      [&](std::uint32_t x, std::uint32_t y) { return picture.at(x, y).coverage; });
    for (std::size_t i = 0; i < keep.size(); ++i) {
        if (!(own[i] > 0) || keep[i] >= 1) {  // nothing to leave, or nobody to leave it to
            keep[i] = 1;
            continue;
        }
        // Layers of random hair let through the product of what each does.
        const float hidden = chart.hidden[i];
        const float wanted = std::pow(1 - hidden, 1 + kLayers * hidden * hidden);
        const float missing = std::clamp(1 - wanted / std::max(keep[i], 1e-6f), 0.0f, 1.0f);
        keep[i] = std::min(1.0f, missing / own[i]);
    }
    for (std::uint32_t y = 0; y < picture.height; ++y) {
        for (std::uint32_t x = 0; x < picture.width; ++x) {
            const Vec2f at = squares.ofTexel(x, y, picture.width, picture.height);
            picture.at(x, y).coverage *= squares.between(keep, at);
        }
    }
}

}  // namespace hairloom::cards
