// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Ribbons of hair sorted into tiles of a picture or map, so that a thread has the pixels of a tile for
// itself: no atomics, and one order of work whatever the number of threads. The ribbons are those of
// shaders/render/ribbon_raster.hlsli, to whose words this keeps.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/software/hlsl.h"
#include "core/software/ribbon_lanes.h"
#include "shaders/shared/render_types.h"

namespace hairloom::software {

/// A part of the hair, by its curve points as the device has them.
struct RibbonBatch {
    std::span<const shaders::CurvePoint> curve;
    shaders::ViewConstants view;
};

/// Where ribbons are drawn: a window of a buffer.
struct RibbonWindow {
    int left = 0, top = 0, columns = 0, rows = 0;  ///< pixels
    float reach = 0;  ///< farthest from a pixel's middle that something is looked for, pixels
};

class RibbonTiles {
  public:
    static constexpr int kSide = 32;  ///< pixels of a tile

    struct Tile {
        int left = 0, top = 0, right = 0, bottom = 0;  ///< pixels of the buffer, the last not included
    };

    RibbonTiles(std::span<const RibbonBatch> batches, const RibbonWindow& window);

    std::size_t count() const { return static_cast<std::size_t>(across_) * static_cast<std::size_t>(down_); }
    Tile tile(std::size_t index) const;
    bool empty(std::size_t index) const { return starts_[index] == starts_[index + 1]; }
    std::uint32_t firstItem(std::size_t batch) const { return firstItems_[batch]; }
    /// Of an item, which numbers the points of all batches.
    std::pair<std::uint32_t, std::uint32_t> batchAndPoint(std::uint32_t item) const;

    /// Calls visit(piece, item, hits) for all pieces that have pixels in the tile, in their order.
    template <class Visit>
    void visit(std::size_t index, Visit&& visit) const {
        const Tile box = tile(index);
        const PixelBox pixels{box.left, box.top, box.right - 1, box.bottom - 1};
        RibbonHits hits;
        for (std::uint32_t k = starts_[index]; k < starts_[index + 1]; ++k) {
            const RibbonPiece piece = pieceOf(items_[k]);
            findHits_(piece, pixels, window_.reach, hits);
            if (hits.count > 0) visit(piece, items_[k], hits);
        }
    }
    /// The same from the nearest piece on, up to those that lie behind `farthest`, bits of a depth that
    /// `visit` may lessen.
    template <class Visit>
    void visitInOrder(std::size_t index, const std::uint32_t& farthest, Visit&& visit) const {
        const Tile box = tile(index);
        const PixelBox pixels{box.left, box.top, box.right - 1, box.bottom - 1};
        RibbonHits hits;
        for (const std::uint64_t next : nearestFirst(index)) {
            if (static_cast<std::uint32_t>(next >> 32u) > farthest) break;
            const auto item = static_cast<std::uint32_t>(next);
            const RibbonPiece piece = pieceOf(item);
            findHits_(piece, pixels, window_.reach, hits);
            if (hits.count > 0) visit(piece, item, hits);
        }
    }
    std::size_t bytes() const {
        return projected_.size() * sizeof(Projected) +
               (items_.size() + starts_.size()) * sizeof(std::uint32_t);
    }

  private:
    /// A curve point on the screen: both corners of the ribbon there.
    struct Projected {
        float x0 = 0, y0 = 0, x1 = 0, y1 = 0;
        float depth = 0;
        float coverage = -1;  ///< below 0: not before the eye
    };

    /// Least depth as bits, then item, of a tile's pieces.
    std::vector<std::uint64_t> nearestFirst(std::size_t index) const;
    void project();
    void bin();
    RibbonPiece pieceOf(std::uint32_t item) const;

    std::vector<RibbonBatch> batches_;
    RibbonWindow window_;
    FindHits findHits_ = findHits();
    int across_ = 0, down_ = 0;
    std::vector<std::uint32_t> firstItems_;
    std::vector<Projected> projected_;   ///< one an item
    std::vector<std::uint32_t> items_;   ///< tile after tile
    std::vector<std::uint32_t> starts_;  ///< of each tile in them, then of all
};

}  // namespace hairloom::software
