// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Opacity maps of hair as a light or the sky sees it: what light_first.comp.hlsl, light_layers.comp.hlsl
// and light_link.comp.hlsl do on a GPU, tile by tile.

#include <list>
#include <memory>

#include "core/software/ribbon_tiles.h"
#include "core/software/stop.h"

namespace hairloom::software {

class LightMaps {
  public:
    explicit LightMaps(Stop stop = {}) : stop_(std::move(stop)) {}

    /// The least depth of hair in each pixel, as bits; `first` holds what other hair has there.
    void drawFirstHair(const RibbonBatch& batch, const shaders::RasterConstants& raster,
                       std::span<std::uint32_t> first);
    /// Adds the hair's coverage, in counts, to the layers of the window's pixels.
    void countLayers(const RibbonBatch& batch, const shaders::RasterConstants& raster,
                     std::span<const std::uint32_t> first, std::span<std::uint32_t> counts);
    /// Counts what lies in the window's pixels into `listed`, or links it, as the phase says.
    void listFragments(const RibbonBatch& batch, const shaders::RasterConstants& raster,
                       std::span<std::uint32_t> listed, std::span<std::uint32_t> begins,
                       std::span<std::uint32_t> fragments);
    /// Curves are about to change, or all maps are drawn.
    void forget();

  private:
    /// What the first of both has sorted serves the second.
    struct Kept {
        RibbonBatch batch;
        shaders::float4 window;
        std::unique_ptr<RibbonTiles> tiles;
    };
    /// A curve with every other point.
    struct Coarse {
        std::span<const shaders::CurvePoint> fine;
        std::vector<shaders::CurvePoint> points;
    };
    RibbonBatch thinned(const RibbonBatch& batch);
    std::unique_ptr<RibbonTiles> takeTiles(const RibbonBatch& batch, const shaders::RasterConstants& raster);
    void keep(const RibbonBatch& batch, const shaders::RasterConstants& raster,
              std::unique_ptr<RibbonTiles> tiles);

    Stop stop_;
    std::vector<Kept> kept_;
    std::list<Coarse> coarse_;
};

}  // namespace hairloom::software
