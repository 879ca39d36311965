// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Hair as the nearest fragments of each pixel in their order: what strand_sorted.comp.hlsl and
// resolve_sorted.comp.hlsl do on a GPU, tile by tile. Between the two it is known which points of the hair
// show at all.

#include <memory>

#include "core/software/ribbon_tiles.h"
#include "core/software/stop.h"

namespace hairloom::software {

/// Light of a batch's curve points.
struct HairLight {
    std::span<const float4> mean;           ///< of their width
    std::span<const std::uint32_t> across;  ///< HAIRLOOM_ACROSS_CELLS each, where it changes over that
};

class SortedHair {
  public:
    /// `stop` leaves tiles of find() out; nothing of it may be shown then.
    explicit SortedHair(const shaders::RasterConstants& raster, Stop stop = {})
        : raster_(raster), stop_(std::move(stop)) {}

    void add(const RibbonBatch& batch) { batches_.push_back(batch); }
    bool found() const { return tiles_ != nullptr; }

    /// Looks for the fragments. `nearest`: depths of what hides hair as bits, `samples` a pixel. Writes into
    /// `cover` of each pixel how much all its hair lets through, where the shader has it.
    void find(std::span<const std::uint32_t> nearest, std::span<std::uint32_t> cover);

    /// A batch has light that changes over its width.
    bool changesAcross(std::size_t batch) const {
        return batches_[batch].view.across != HAIRLOOM_ACROSS_NONE;
    }

    /// 1 for each point of a batch whose light some pixel shows; as many as its curve has.
    std::vector<std::uint8_t> shownPoints(std::size_t batch) const;

    /// Hair over the mean of the samples, added to the sum of frames, four floats a pixel. `light`: of
    /// samples, packed; `hair`: of each batch.
    void resolve(const shaders::ResolveConstants& how, std::span<const std::uint32_t> nearest,
                 std::span<const std::uint32_t> light, std::span<const HairLight> hair,
                 std::span<float4> sum) const;

  private:
    struct Fragment {
        std::uint32_t depth;  ///< bits
        std::uint32_t item;   ///< of RibbonTiles
        float along;          ///< 0...1 between the item's point and the next
        float cover;
        std::int16_t across, reach;  ///< of AcrossPlace, in kAcrossUnits
    };
    /// Of the pixels of a tile, row after row.
    struct Found {
        std::vector<std::uint16_t> starts;  ///< of each pixel's fragments, then of all
        std::vector<float> through;         ///< what all hair of the pixel lets through
        std::vector<Fragment> fragments;
    };
    void findIn(std::size_t tile, std::span<const std::uint32_t> nearest, std::span<std::uint32_t> cover);
    float4 hairOver(const float4& behind, const Found& found, std::size_t pixel,
                    std::span<const HairLight> hair) const;

    shaders::RasterConstants raster_;
    Stop stop_;
    std::vector<RibbonBatch> batches_;
    std::unique_ptr<RibbonTiles> tiles_;
    std::vector<Found> found_;  ///< one a tile; empty where no hair is
};

}  // namespace hairloom::software
