// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/software/sorted_hair.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"

namespace hairloom::software {
namespace {

/// Of a pixel, at most. Four times a GPU's, because light that is worked out for those behind is noisy.
constexpr std::uint32_t kFragments = 4 * HAIRLOOM_FRAGMENTS;
constexpr std::uint32_t kNothing = 0x3f800000u;  // the depth 1
constexpr float kLeastThrough = 1.0f / 512;      // a pixel that lets less through lets nothing through
constexpr std::uint32_t kMostHalvings = 9u * HAIRLOOM_HALVING_STEPS;
constexpr float kLeastCover = 0.5f / 65535;
constexpr std::size_t kTilePixels = std::size_t{RibbonTiles::kSide} * RibbonTiles::kSide;

float powerOf2(int n) {
    return asfloat(static_cast<std::uint32_t>(127 + n) << 23u);
}

/// As raster.hlsli packs it.
float3 unpackedLight(std::uint32_t packed) {
    const float scale = powerOf2(static_cast<int>(packed >> 27u) - 24);
    return float3(static_cast<float>(packed & 511u), static_cast<float>((packed >> 9u) & 511u),
                  static_cast<float>((packed >> 18u) & 511u)) *
           scale;
}

constexpr float kAcrossUnits = 16383;  // they lie in -2 to 2

/// As ribbon_raster.hlsli has them: from side to side, -1 to 1, and half of what a pixel has of that.
struct AcrossPlace {
    float middle, reach;
};
AcrossPlace placeAcross(const RibbonPiece& piece, float x, float y) {
    const auto distanceTo = [&](const std::array<float, 3>& border) {
        return border[0] * (x + 0.5f) + border[1] * (y + 0.5f) + border[2];
    };
    const float left = distanceTo(piece.left);
    const float right = distanceTo(piece.right);
    const float pixels = max(left + right, 1e-6f);
    return {clamp((left - right) / pixels, -2.0f, 2.0f), min(1 / pixels, 1.0f)};
}

/// As across.hlsli has it.
float3 lightOver(const HairLight& hair, std::uint32_t point, float along, const AcrossPlace& place) {
    constexpr auto kCells = static_cast<float>(HAIRLOOM_ACROSS_CELLS);
    const float most = max(place.reach * 0.5f * kCells, 0.5f);
    const float middle = (0.5f + 0.5f * place.middle) * kCells;
    const float begin = clamp(middle - most, 0.0f, kCells - 0.5f);
    const float end = clamp(middle + most, begin + 0.5f, kCells);
    float3 here(0.0f);
    float3 next(0.0f);
    const std::uint32_t* const cells = hair.across.data() + std::size_t{point} * HAIRLOOM_ACROSS_CELLS;
    for (auto cell = static_cast<std::uint32_t>(begin);
         cell < HAIRLOOM_ACROSS_CELLS && static_cast<float>(cell) < end; ++cell) {
        const float part = min(static_cast<float>(cell) + 1, end) - max(static_cast<float>(cell), begin);
        here += unpackedLight(cells[cell]) * part;
        next += unpackedLight(cells[HAIRLOOM_ACROSS_CELLS + cell]) * part;
    }
    return lerp(here, next, float3(along)) / (end - begin);
}

/// As resolve_sorted.comp.hlsl has it.
float3 lightBehind(const float3& nearer, const float3& farther, float through, float least) {
    const float ofHalf = max(-0.5f * std::log(max(through, 1e-4f)), 1e-3f);
    const float depth = std::log(max(through, 1e-6f) / max(least, 1e-6f));
    const auto channel = [&](float near, float far) {
        const float fall = clamp(far / max(near, 1e-6f), 1e-3f, 1.0f);
        const float falls = min(-std::log(fall) / ofHalf, 1.0f);
        return through * far * std::exp(-0.5f * ofHalf * falls) * (1.0f - std::exp(-depth * (1.0f + falls))) /
               (1.0f + falls);
    };
    return float3(channel(nearer.x, farther.x), channel(nearer.y, farther.y), channel(nearer.z, farther.z));
}

}  // namespace

void SortedHair::find(std::span<const std::uint32_t> nearest, std::span<std::uint32_t> cover) {
    const RibbonWindow window{static_cast<int>(raster_.window.x), static_cast<int>(raster_.window.y),
                              static_cast<int>(raster_.window.z), static_cast<int>(raster_.window.w),
                              raster_.sampleReach};
    tiles_ = std::make_unique<RibbonTiles>(batches_, window);
    found_.resize(tiles_->count());
    parallelUntil(stop_, tiles_->count(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) {
            if (!tiles_->empty(t)) findIn(t, nearest, cover);
        }
    });
}

void SortedHair::findIn(std::size_t tile, std::span<const std::uint32_t> nearest,
                        std::span<std::uint32_t> cover) {
    const RibbonTiles::Tile box = tiles_->tile(tile);
    const std::uint32_t samples = raster_.samples;
    const float eachSample = 1.0f / static_cast<float>(samples);
    const auto columns = static_cast<std::size_t>(box.right - box.left);
    const std::size_t pixels = columns * static_cast<std::size_t>(box.bottom - box.top);
    std::vector<Fragment> fragments(kTilePixels * kFragments);
    std::vector<std::uint8_t> counts(pixels, 0);
    Found& result = found_[tile];
    result.through.assign(pixels, 1.0f);
    const auto bufferAt = [&](int x, int y) {
        return static_cast<std::size_t>(y) * raster_.bufferWidth + static_cast<std::size_t>(x);
    };
    std::size_t open = pixels;  // that let light through, or have room for fragments
    bool bounded = false;
    const bool changes = changesAcross(0);
    std::vector<std::uint8_t> closed(pixels, 0);
    const auto visitPixel = [&](const RibbonPiece& piece, std::uint32_t item, const RibbonHits& hits,
                                std::size_t h) {
        const float depth = hits.depth[h];
        if (!(depth >= 0 && depth < 1)) return;
        const std::uint32_t bits = asuint(depth);
        const int x = piece.originX + static_cast<int>(hits.x[h]);
        const int y = piece.originY + static_cast<int>(hits.y[h]);
        const std::size_t pixel =
            static_cast<std::size_t>(y - box.top) * columns + static_cast<std::size_t>(x - box.left);
        Fragment* const kept = fragments.data() + pixel * kFragments;
        std::uint8_t& count = counts[pixel];
        const bool full = count == kFragments;
        const bool keeps = !full || bits < kept[kFragments - 1].depth;
        float& through = result.through[pixel];
        if (!keeps && through < kLeastThrough) return;
        const std::uint32_t* const hides = nearest.data() + bufferAt(x, y) * samples;
        std::uint32_t seen = 0;
        for (std::uint32_t s = 0; s < samples; ++s) seen += hides[s] > bits ? 1u : 0u;
        const float along = hits.along[h];
        const float covers = saturate(hits.inside[h] + 0.5f) * (static_cast<float>(seen) * eachSample) *
                             lerp(piece.coverageBegin, piece.coverageEnd, along);
        if (covers < kLeastCover) return;
        through *= 1.0f - min(covers, 0.9999f);
        if (!keeps) {
            if (closed[pixel] == 0 && through < kLeastThrough) {
                closed[pixel] = 1;
                --open;
            }
            return;
        }
        std::size_t place = full ? kFragments - 1 : count++;
        while (place > 0 && kept[place - 1].depth > bits) {
            kept[place] = kept[place - 1];
            --place;
        }
        const AcrossPlace across = changes ? placeAcross(piece, hits.x[h], hits.y[h]) : AcrossPlace{0, 0};
        kept[place] = {bits,
                       item,
                       along,
                       covers,
                       static_cast<std::int16_t>(across.middle * kAcrossUnits),
                       static_cast<std::int16_t>(across.reach * kAcrossUnits)};
        if (closed[pixel] == 0 && count == kFragments && through < kLeastThrough) {
            closed[pixel] = 1;
            --open;
        }
    };
    // Nothing shows behind the head, nor behind the last fragments where no pixel lets light through.
    std::uint32_t farthest = 0;
    for (int y = box.top; y < box.bottom; ++y) {
        const auto row = nearest.subspan(bufferAt(box.left, y) * samples, columns * samples);
        farthest = max(farthest, *std::ranges::max_element(row));
    }
    tiles_->visitInOrder(tile, farthest,
                         [&](const RibbonPiece& piece, std::uint32_t item, const RibbonHits& hits) {
                             for (std::size_t h = 0; h < hits.count; ++h) visitPixel(piece, item, hits, h);
                             if (open > 0 || bounded) return;
                             bounded = true;
                             std::uint32_t last = 0;
                             for (std::size_t p = 0; p < pixels; ++p)
                                 last = max(last, fragments[p * kFragments + kFragments - 1].depth);
                             farthest = min(farthest, last);
                         });
    result.starts.assign(pixels + 1, 0);
    std::size_t all = 0;
    for (std::size_t p = 0; p < pixels; ++p) {
        // What those before it hide needs neither light nor room.
        const Fragment* const kept = fragments.data() + p * kFragments;
        float through = 1;
        std::uint8_t shown = 0;
        while (shown < counts[p] && through >= kLeastThrough) through *= 1.0f - kept[shown++].cover;
        counts[p] = shown;
        result.starts[p] = static_cast<std::uint16_t>(all);
        all += counts[p];
    }
    result.starts[pixels] = static_cast<std::uint16_t>(all);
    result.fragments.reserve(all);
    for (std::size_t p = 0; p < pixels; ++p) {
        const Fragment* const kept = fragments.data() + p * kFragments;
        result.fragments.insert(result.fragments.end(), kept, kept + counts[p]);
        if (result.through[p] >= kLeastThrough) continue;
        // What the head's light looks at: hair hides it.
        const int x = box.left + static_cast<int>(p % columns);
        const int y = box.top + static_cast<int>(p / columns);
        cover[bufferAt(x, y) * HAIRLOOM_COVER_WORDS + HAIRLOOM_COVER_WORDS - 1] = kMostHalvings;
    }
}

std::vector<std::uint8_t> SortedHair::shownPoints(std::size_t batch) const {
    const std::uint32_t first = tiles_->firstItem(batch);
    const auto count = static_cast<std::uint32_t>(batches_[batch].curve.size());
    std::vector<std::uint8_t> shown(count, 0);
    for (const Found& found : found_) {
        for (const Fragment& fragment : found.fragments) {
            const std::uint32_t point = fragment.item - first;
            if (point + 1 < count) shown[point] = shown[point + 1] = 1;
        }
    }
    return shown;
}

float4 SortedHair::hairOver(const float4& behind, const Found& found, std::size_t pixel,
                            std::span<const HairLight> hair) const {
    float through = 1;
    float3 light(0.0f);
    float3 halves[2] = {float3(0.0f), float3(0.0f)};
    float covers[2] = {0, 0};
    const std::size_t start = found.starts[pixel];
    for (std::size_t k = start; k < found.starts[pixel + 1]; ++k) {
        const Fragment& fragment = found.fragments[k];
        const auto [batch, point] = tiles_->batchAndPoint(fragment.item);
        const float4* const mean = hair[batch].mean.data() + point;
        const float3 own = changesAcross(batch)
                               ? lightOver(hair[batch], point, fragment.along,
                                           {static_cast<float>(fragment.across) / kAcrossUnits,
                                            static_cast<float>(fragment.reach) / kAcrossUnits})
                               : lerp(mean[0].xyz(), mean[1].xyz(), float3(fragment.along));
        const float3 part = clamp(own, float3(0.0f), float3(65408.0f)) * fragment.cover;
        light += part * through;
        through *= 1.0f - fragment.cover;
        const std::size_t half = (k - start) / (kFragments / 2);
        halves[half] += part;
        covers[half] += fragment.cover;
    }
    const float all = found.through[pixel] < kLeastThrough ? 0.0f : found.through[pixel];
    const float least = min(all, through);
    if (covers[1] > 0) {
        const float3 nearer = halves[0] / covers[0];
        const float3 farther = halves[1] / covers[1];
        light += lightBehind(nearer, farther, through, least);
        through = least;
    }
    return float4(light, 1.0f - through) + behind * through;
}

void SortedHair::resolve(const shaders::ResolveConstants& how, std::span<const std::uint32_t> nearest,
                         std::span<const std::uint32_t> light, std::span<const HairLight> hair,
                         std::span<float4> sum) const {
    const std::uint32_t samples = how.samples;
    const float4 background(how.background.x, how.background.y, how.background.z, how.background.w);
    parallelFor(tiles_->count(), 4, [&](std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) {
            const RibbonTiles::Tile box = tiles_->tile(t);
            std::size_t pixel = 0;
            for (int y = box.top; y < box.bottom; ++y) {
                for (int x = box.left; x < box.right; ++x, ++pixel) {
                    const std::size_t at =
                        static_cast<std::size_t>(y) * raster_.bufferWidth + static_cast<std::size_t>(x);
                    float4 frame(0.0f);
                    for (std::uint32_t s = 0; s < samples; ++s) {
                        const bool nothing = asfloat(nearest[at * samples + s]) >= 1;
                        frame += nothing ? background : float4(unpackedLight(light[at * samples + s]), 1.0f);
                    }
                    frame = frame / static_cast<float>(samples);
                    if (!tiles_->empty(t)) frame = hairOver(frame, found_[t], pixel, hair);
                    sum[at] = how.sumBegins != 0 ? frame : sum[at] + frame;
                }
            }
        }
    });
}

}  // namespace hairloom::software
