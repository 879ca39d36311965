// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/software/light_maps.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>

namespace hairloom::software {
namespace {

constexpr float kFibreCount = 65536;  // one whole fibre, as opacity.hlsli counts it

constexpr std::uint32_t kMostStrands = 16384;               // that a map counts
constexpr std::size_t kMostKept = std::size_t{256} << 20u;  // bytes

std::unique_ptr<RibbonTiles> tilesOf(const RibbonBatch& batch, const shaders::RasterConstants& raster) {
    const RibbonWindow window{static_cast<int>(raster.window.x), static_cast<int>(raster.window.y),
                              static_cast<int>(raster.window.z), static_cast<int>(raster.window.w),
                              raster.sampleReach};
    return std::make_unique<RibbonTiles>(std::span(&batch, 1), window);
}

bool same(const RibbonBatch& a, const RibbonBatch& b) {
    return a.curve.data() == b.curve.data() && a.curve.size() == b.curve.size() &&
           std::memcmp(&a.view, &b.view, sizeof(a.view)) == 0;
}

/// As opacity.hlsli has it.
float metresBehind(const shaders::ViewConstants& view, float depth) {
    const float farPlane = view.nearPlane + view.depthRange;
    return view.nearPlane > 0
               ? view.nearPlane * farPlane / (farPlane - depth * view.depthRange) - view.nearPlane
               : depth * view.depthRange;
}

/// As opacity.hlsli has it.
std::uint32_t layerAt(float part, std::uint32_t count, float growth) {
    const auto all = static_cast<float>(count);
    float place = part;
    if (growth == 0) {
        place = part < 0.04f   ? part / 0.12f
                : part < 0.14f ? 1.0f / 3 + (part - 0.04f) / 0.3f
                               : 2.0f / 3 + (part - 0.14f) / 2.58f;
    } else if (std::abs(growth - 1) >= 1e-3f) {
        place = std::log(1 + max(part, 0.0f) * (std::pow(growth, all) - 1)) / (std::log(growth) * all);
    }
    return static_cast<std::uint32_t>(std::clamp(place * all, 0.0f, all - 1));
}

/// As adaptive.hlsli has it.
std::uint32_t chanceOf(std::uint32_t a, std::uint32_t b) {
    std::uint32_t h = a * 747796405u + b * 2891336453u + 277803737u;
    h = ((h >> ((h >> 28u) + 4u)) ^ h) * 277803737u;
    return (h >> 22u) ^ h;
}

/// As adaptive.hlsli has it.
float listedShare(std::uint32_t all, std::uint32_t most) {
    return all <= most ? 1.0f : 0.98f * static_cast<float>(most) / static_cast<float>(all);
}

/// As adaptive.hlsli has it.
float listedShareOfTexel(std::uint32_t found) {
    return found <= HAIRLOOM_LISTED_OF_TEXEL
               ? 1.0f
               : 0.94f * static_cast<float>(HAIRLOOM_LISTED_OF_TEXEL) / static_cast<float>(found);
}

}  // namespace

void LightMaps::forget() {
    kept_.clear();
    coarse_.clear();
}

RibbonBatch LightMaps::thinned(const RibbonBatch& batch) {
    RibbonBatch result = batch;
    if (batch.curve.empty() || batch.view.eachHair > 0) return result;
    const std::uint32_t strands = batch.curve.back().strand + 1;
    if (strands > kMostStrands) {
        // Strands stand in an order of chance.
        const auto end =
            std::ranges::lower_bound(batch.curve, kMostStrands, {}, &shaders::CurvePoint::strand);
        result.curve = batch.curve.first(static_cast<std::size_t>(end - batch.curve.begin()));
        result.view.fibresForEach *= static_cast<float>(strands) / static_cast<float>(kMostStrands);
    }
    const auto found = std::ranges::find_if(coarse_, [&](const Coarse& coarse) {
        return coarse.fine.data() == result.curve.data() && coarse.fine.size() == result.curve.size();
    });
    if (found != coarse_.end()) {
        result.curve = found->points;
        return result;
    }
    Coarse& coarse = coarse_.emplace_back(Coarse{result.curve, {}});
    coarse.points.reserve(result.curve.size() / 2 + strands);
    std::size_t begin = 0;
    for (std::size_t i = 0; i < result.curve.size(); ++i) {
        const bool first = i == 0 || result.curve[i - 1].strand != result.curve[i].strand;
        const bool last =
            i + 1 == result.curve.size() || result.curve[i + 1].strand != result.curve[i].strand;
        if (first) begin = i;
        if (last || (i - begin) % 2 == 0) coarse.points.push_back(result.curve[i]);
    }
    result.curve = coarse.points;
    return result;
}

std::unique_ptr<RibbonTiles> LightMaps::takeTiles(const RibbonBatch& batch,
                                                  const shaders::RasterConstants& raster) {
    const auto found = std::ranges::find_if(kept_, [&](const Kept& kept) {
        return same(kept.batch, batch) && std::memcmp(&kept.window, &raster.window, sizeof(kept.window)) == 0;
    });
    if (found == kept_.end()) return tilesOf(batch, raster);
    std::unique_ptr<RibbonTiles> tiles = std::move(found->tiles);
    kept_.erase(found);
    return tiles;
}

void LightMaps::keep(const RibbonBatch& batch, const shaders::RasterConstants& raster,
                     std::unique_ptr<RibbonTiles> tiles) {
    std::size_t bytes = tiles->bytes();
    for (const Kept& kept : kept_) bytes += kept.tiles->bytes();
    if (bytes <= kMostKept) kept_.push_back({batch, raster.window, std::move(tiles)});
}

void LightMaps::drawFirstHair(const RibbonBatch& all, const shaders::RasterConstants& raster,
                              std::span<std::uint32_t> first) {
    const RibbonBatch batch = thinned(all);
    std::unique_ptr<RibbonTiles> tiles = tilesOf(batch, raster);
    parallelUntil(stop_, tiles->count(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) {
            tiles->visit(t, [&](const RibbonPiece& piece, std::uint32_t /*item*/, const RibbonHits& hits) {
                for (std::size_t h = 0; h < hits.count; ++h) {
                    const float depth = hits.depth[h];
                    if (!(depth >= 0)) continue;
                    const auto x = static_cast<std::size_t>(piece.originX + static_cast<int>(hits.x[h]));
                    const auto y = static_cast<std::size_t>(piece.originY + static_cast<int>(hits.y[h]));
                    std::uint32_t& least = first[y * raster.bufferWidth + x];
                    least = min(least, asuint(depth));
                }
            });
        }
    });
    keep(batch, raster, std::move(tiles));
}

void LightMaps::listFragments(const RibbonBatch& all, const shaders::RasterConstants& raster,
                              std::span<std::uint32_t> listed, std::span<std::uint32_t> begins,
                              std::span<std::uint32_t> fragments) {
    const RibbonBatch batch = thinned(all);
    const bool counts = raster.phase == HAIRLOOM_PHASE_COUNT;
    std::unique_ptr<RibbonTiles> tiles = counts ? tilesOf(batch, raster) : takeTiles(batch, raster);
    const std::atomic_ref<std::uint32_t> found(listed[2 * raster.square]);
    const std::atomic_ref<std::uint32_t> linked(listed[2 * raster.square + 1]);
    const float ofAll = counts ? 1 : listedShare(found.load(), raster.fragments);
    const auto left = static_cast<std::size_t>(raster.window.x);
    const auto top = static_cast<std::size_t>(raster.window.y);
    const auto columns = static_cast<std::size_t>(raster.window.z);
    const std::size_t texels = columns * static_cast<std::size_t>(raster.window.w);
    const auto listOne = [&](const RibbonPiece& piece, std::uint32_t item, const RibbonHits& hits,
                             std::size_t h) {
        const auto x = static_cast<std::size_t>(piece.originX + static_cast<int>(hits.x[h]));
        const auto y = static_cast<std::size_t>(piece.originY + static_cast<int>(hits.y[h]));
        const std::size_t texel = (y - top) * columns + (x - left);
        // A tile has its texels for itself.
        if (counts) {
            ++begins[texels + texel];
            return;
        }
        const float share = min(ofAll, listedShareOfTexel(begins[texels + texel]));
        const auto least = static_cast<std::uint32_t>(share * 4294967040.0f);
        if (share < 1 && chanceOf(item, static_cast<std::uint32_t>(texel)) >= least) return;
        const std::uint32_t place = linked.fetch_add(1, std::memory_order_relaxed);
        if (place >= raster.fragments) return;
        const float cover =
            saturate(lerp(piece.coverageBegin, piece.coverageEnd, hits.along[h])) * batch.view.fibresForEach;
        std::uint32_t* const fragment = &fragments[std::size_t{HAIRLOOM_LISTED_WORDS} * place];
        fragment[0] = asuint(hits.depth[h]);
        fragment[1] = static_cast<std::uint32_t>(cover * kFibreCount / share + 0.5f);
        fragment[2] = begins[texel];
        begins[texel] = place + 1;
    };
    parallelUntil(stop_, tiles->count(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) {
            std::uint32_t here = 0;
            tiles->visit(t, [&](const RibbonPiece& piece, std::uint32_t item, const RibbonHits& hits) {
                for (std::size_t h = 0; h < hits.count; ++h) {
                    if (!(hits.depth[h] >= 0 && hits.depth[h] <= 1)) continue;
                    ++here;
                    listOne(piece, item, hits, h);
                }
            });
            if (counts) found.fetch_add(here, std::memory_order_relaxed);
        }
    });
    if (counts) keep(batch, raster, std::move(tiles));
}

void LightMaps::countLayers(const RibbonBatch& all, const shaders::RasterConstants& raster,
                            std::span<const std::uint32_t> first, std::span<std::uint32_t> counts) {
    const RibbonBatch batch = thinned(all);
    const std::unique_ptr<RibbonTiles> tiles = takeTiles(batch, raster);
    const shaders::ViewConstants& view = batch.view;
    const bool fixedLayers = view.shadows == HAIRLOOM_SHADOWS_OPACITY_MAPS;
    const bool few = raster.layers == (fixedLayers ? 4u : 3u);
    const auto left = static_cast<std::size_t>(raster.window.x);
    const auto top = static_cast<std::size_t>(raster.window.y);
    const auto columns = static_cast<std::size_t>(raster.window.z);
    const auto countOne = [&](const RibbonPiece& piece, const RibbonHits& hits, std::size_t h) {
        const float depth = hits.depth[h];
        if (!(depth >= 0 && depth <= 1)) return;
        const float cover = saturate(lerp(piece.coverageBegin, piece.coverageEnd, hits.along[h]));
        const auto amount = static_cast<std::uint32_t>(cover * view.fibresForEach * kFibreCount + 0.5f);
        const auto x = static_cast<std::size_t>(piece.originX + static_cast<int>(hits.x[h]));
        const auto y = static_cast<std::size_t>(piece.originY + static_cast<int>(hits.y[h]));
        const float begins =
            fixedLayers ? view.hairBegins : metresBehind(view, asfloat(first[y * raster.bufferWidth + x]));
        const float behind = metresBehind(view, depth) - begins;
        const std::uint32_t layer = few ? (behind >= view.layers.x ? 1u : 0u) +
                                              (behind >= view.layers.y ? 1u : 0u) +
                                              (behind >= view.layers.z ? 1u : 0u)
                                        : layerAt(behind / (fixedLayers ? view.layers.w : view.layers.z),
                                                  raster.layers, raster.layerGrowth);
        const std::size_t texel = (y - top) * columns + (x - left);
        counts[texel * raster.layers + min(layer, raster.layers - 1)] += amount;
    };
    parallelUntil(stop_, tiles->count(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) {
            tiles->visit(t, [&](const RibbonPiece& piece, std::uint32_t /*item*/, const RibbonHits& hits) {
                for (std::size_t h = 0; h < hits.count; ++h) countOne(piece, hits, h);
            });
        }
    });
}

}  // namespace hairloom::software
