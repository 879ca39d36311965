// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/cards/texture.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/cards/raster.h"

namespace hairloom::cards {
namespace {

/// A point of a strand on the card.
struct FlatPoint {
    float across = 0, along = 0;  // metres; samples follow from the strip's width there
    float off = 0;
    float open = 1;                // ambient occlusion
    float x = 0, y = 0;            // shares of the picture
    Vec2f radius = Vec2f::Zero();  // likewise
};

/// A strand on the card from where on it is shown.
struct FlatStrand {
    std::uint32_t first = 0;  // of the hair, the point before where it begins
    float from = 0;           // share of the way to the next one
    std::vector<FlatPoint> points;
};

FlatPoint between(const FlatPoint& a, const FlatPoint& b, float t) {
    const auto mix = [t](const auto& x, const auto& y) { return x + t * (y - x); };
    return {mix(a.across, b.across),       mix(a.along, b.along), mix(a.off, b.off),
            mix(a.open, b.open),           mix(a.x, b.x),         mix(a.y, b.y),
            Vec2f(mix(a.radius, b.radius))};
}

/// Cuts off what lies on the skin.
void clearSkin(const Hair& hair, std::uint32_t s, float clear, FlatStrand& flat) {
    // No two strands leave the cap at one height, or a line would be seen there.
    const float own = hashUnit(s, 23, 0);
    const float rise = clear * (0.6f + 0.8f * own), most = kOnCap * (0.6f + 0.4f * own);
    const auto points = hair.strand(s);
    float way = 0, height = 0;
    for (std::uint32_t p = 0; p + 1 < points.size(); ++p) {
        const float step = (points[p + 1] - points[p]).norm();
        const float next = (points[p + 1] - points[0]).dot(hair.rootNormals_ws[s]);
        if (next < rise && way + step < most) {
            way += step, height = next;
            continue;
        }
        float t = step > 0 ? std::clamp((most - way) / step, 0.0f, 1.0f) : 0.0f;
        if (next >= rise && next > height) t = std::min(t, std::max(0.0f, (rise - height) / (next - height)));
        flat.points[p] = between(flat.points[p], flat.points[p + 1], t);
        flat.points.erase(flat.points.begin(), flat.points.begin() + p);
        flat.first += p, flat.from = t;
        return;
    }
    flat.points.clear();
}

FlatStrand flattened(const Hair& hair, const HairLight& light, const Strip& strip, std::uint32_t s,
                     const BakeOptions& options) {
    const float length = strip.length();
    FlatStrand flat{hair.offsets[s], 0, {}};
    const auto places = placesOn(strip, hair.strand(s));
    for (std::size_t p = hair.offsets[s]; p < hair.offsets[s + 1]; ++p) {
        const StripPlace& place = places[p - hair.offsets[s]];
        const float t = std::clamp(place.share, 0.0f, 1.0f);
        const float half = (1 - t) * strip.halfWidth[place.station] + t * strip.halfWidth[place.station + 1];
        FlatPoint point;
        point.across = place.across, point.off = place.off, point.along = place.along * length;
        point.x = 0.5f + 0.5f * place.across / half;
        point.y = place.along;
        point.open = light.open(options.grown_ws.empty() ? hair.positions_ws[p] : options.grown_ws[p]);
        point.radius = options.thickness * hair.radii[p] * Vec2f(0.5f / half, 1 / length);
        flat.points.push_back(point);
    }
    if (options.clear > 0) clearSkin(hair, s, options.clear, flat);
    return flat;
}

/// What the outermost strand shows at a sample.
struct Sample {
    float off = -std::numeric_limits<float>::infinity();
    std::uint32_t point = 0;  // of the hair, the one before
    float t = 0;
    float open = 1;
    float side = 0;  // -1 … 1 across the strand
    Vec2f flow = Vec2f(0, 1);
    std::uint32_t strand = 0;
};

class Canvas {
  public:
    Canvas(std::uint32_t width, std::uint32_t height, int finer)
        : width_(static_cast<int>(width) * finer),
          height_(static_cast<int>(height) * finer),
          samples_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_)) {}

    void draw(std::uint32_t strand, const FlatStrand& flat) {
        const Vec2f size(static_cast<float>(width_), static_cast<float>(height_));
        for (std::size_t p = 0; p + 1 < flat.points.size(); ++p) {
            const FlatPoint &a = flat.points[p], &b = flat.points[p + 1];
            Vec2f flow(b.across - a.across, b.along - a.along);
            if (!(flow.norm() > 0)) continue;
            flow.normalize();
            const LinePoint from{Vec2f(a.x, a.y).cwiseProduct(size), a.radius.cwiseProduct(size)};
            const LinePoint to{Vec2f(b.x, b.y).cwiseProduct(size), b.radius.cwiseProduct(size)};
            if (!(from.radius.minCoeff() > 0)) continue;
            forSamplesOfLine(from, to, width_, {0, height_}, [&](int x, int y, float t) {
                Sample& sample = samples_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                                          static_cast<std::size_t>(x)];
                const float off = a.off + t * (b.off - a.off);
                if (off <= sample.off) return;
                const float middle = from.at.x() + t * (to.at.x() - from.at.x());
                const float half = from.radius.x() + t * (to.radius.x() - from.radius.x());
                const float side = std::clamp((static_cast<float>(x) + 0.5f - middle) / half, -1.0f, 1.0f);
                sample = {off,
                          flat.first + static_cast<std::uint32_t>(p),
                          p == 0 ? flat.from + t * (1 - flat.from) : t,
                          a.open + t * (b.open - a.open),
                          side,
                          flow,
                          strand};
            });
        }
    }
    const Sample& at(int x, int y) const {
        return samples_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                        static_cast<std::size_t>(x)];
    }

  private:
    int width_, height_;
    std::vector<Sample> samples_;
};

/// Sums of what is covered.
struct Sum {
    Texel all;
    float weight = 0;

    Sum() {
        all.flow.setZero(), all.normal.setZero();
        all.open = 0;
    }
    void add(const Texel& t, float w) {
        all.albedo += w * t.albedo, all.flow += w * t.flow, all.normal += w * t.normal;
        all.depth += w * t.depth, all.along += w * t.along, all.id += w * t.id, all.open += w * t.open;
        weight += w;
    }
    Texel mean(float coverage) const {
        Texel t;
        t.coverage = coverage;
        if (!(weight > 0)) return t;
        t.albedo = all.albedo / weight, t.flow = all.flow / weight;
        t.normal = all.normal.norm() > 0 ? Vec3f(all.normal.normalized()) : Vec3f(0, 0, 1);
        t.depth = all.depth / weight, t.along = all.along / weight, t.id = all.id / weight;
        t.open = all.open / weight;
        return t;
    }
};

Texel shown(const Hair& hair, const BakeOptions& options, const Sample& sample) {
    const std::uint32_t p = sample.point;
    const float t = sample.t;
    Texel texel;
    texel.albedo = (1 - t) * hair.albedo[p] + t * hair.albedo[p + 1];
    texel.flow = sample.flow;
    const float out = std::sqrt(std::max(0.0f, 1 - sample.side * sample.side));
    texel.normal = Vec3f(sample.side * sample.flow.y(), -sample.side * sample.flow.x(), out);
    texel.depth = sample.off;
    if (!options.grown_ws.empty()) {
        const auto height = [&](std::uint32_t at) {
            return (options.grown_ws[at] - hair.positions_ws[at]).dot(hair.rootNormals_ws[sample.strand]);
        };
        texel.depth = (1 - t) * height(p) + t * height(p + 1);
    }
    const std::uint32_t first = hair.offsets[sample.strand], count = hair.offsets[sample.strand + 1] - first;
    texel.along = (static_cast<float>(p - first) + t) / static_cast<float>(count - 1);
    texel.id = hashUnit(sample.strand, 11, 0);
    texel.open = sample.open;
    return texel;
}

}  // namespace

Picture bake(const Hair& hair, const HairLight& light, const Strip& strip,
             std::span<const std::uint32_t> strands, const BakeOptions& options, std::uint32_t width,
             std::uint32_t height) {
    constexpr int kFiner = 4;
    Canvas canvas(width, height, kFiner);
    for (const std::uint32_t s : strands) canvas.draw(s, flattened(hair, light, strip, s, options));
    Picture picture{width, height, std::vector<Texel>(std::size_t{width} * height)};
    for (std::uint32_t y = 0; y < height; ++y) {
        for (std::uint32_t x = 0; x < width; ++x) {
            Sum sum;
            for (int j = 0; j < kFiner; ++j) {
                for (int i = 0; i < kFiner; ++i) {
                    const Sample& sample =
                        canvas.at(static_cast<int>(x) * kFiner + i, static_cast<int>(y) * kFiner + j);
                    if (std::isfinite(sample.off)) sum.add(shown(hair, options, sample), 1);
                }
            }
            picture.at(x, y) = sum.mean(sum.weight / static_cast<float>(kFiner * kFiner));
        }
    }
    return picture;
}

Picture halved(const Picture& picture) {
    Picture half{(picture.width + 1) / 2, (picture.height + 1) / 2, {}};
    half.texels.reserve(std::size_t{half.width} * half.height);
    for (std::uint32_t y = 0; y < half.height; ++y) {
        for (std::uint32_t x = 0; x < half.width; ++x) {
            Sum sum;
            float coverage = 0;
            for (std::uint32_t k = 0; k < 4; ++k) {
                const Texel& t = picture.at(std::min(2 * x + (k & 1u), picture.width - 1),
                                            std::min(2 * y + (k >> 1u), picture.height - 1));
                sum.add(t, t.coverage + 1e-6f);
                coverage += 0.25f * t.coverage;
            }
            half.texels.push_back(sum.mean(coverage));
        }
    }
    return half;
}

void fillGaps(Picture& picture) {
    if (picture.width <= 1 && picture.height <= 1) return;
    bool gaps = false;
    for (const Texel& t : picture.texels) gaps = gaps || t.coverage <= 0;
    if (!gaps) return;
    Picture half = halved(picture);
    fillGaps(half);
    for (std::uint32_t y = 0; y < picture.height; ++y) {
        for (std::uint32_t x = 0; x < picture.width; ++x) {
            Texel& t = picture.at(x, y);
            if (t.coverage > 0) continue;
            t = half.at(x / 2, y / 2);
            t.coverage = 0;
        }
    }
}

}  // namespace hairloom::cards
