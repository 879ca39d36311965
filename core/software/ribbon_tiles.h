// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Ribbons of hair sorted into tiles of a picture or map, so that a thread has the pixels of a tile for itself: no
// atomics, and one order of work whatever the number of threads. The ribbons are those of
// shaders/render/ribbon_raster.hlsli, to whose words this keeps.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/software/hlsl.h"
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

/// A piece of a ribbon between two points of a curve. Lines (x, y times normal, then offset) are positive inside.
struct RibbonPiece {
    std::uint32_t batch = 0, first = 0;  ///< of its two curve points
    int originX = 0, originY = 0;        ///< pixel that places count from
    float3 begins, ends, left, right;
    float2 depth, coverage;   ///< at begin and end
    float2 start;             ///< middle of its begin
    float2 minimum, maximum;  ///< around it
    float slope = 0, across = 0;
    bool steep = false;

    float distanceTo(const float3& line, float x, float y) const { return line.x * x + line.y * y + line.z; }
    /// Where between begin and end, 0 to 1, or below 0 outside.
    float placeOn(float x, float y) const {
        const float after = distanceTo(begins, x, y);
        const float before = distanceTo(ends, x, y);
        const bool inside =
            after >= 0 && before > 0 && distanceTo(left, x, y) >= 0 && distanceTo(right, x, y) > 0;
        return inside ? after / (after + before) : -1.0f;
    }
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

    /// Calls visit(piece, item, x, y, atX, atY) for all pixels of the tile near each of its pieces, in their order. `at`
    /// is the pixel's middle from the piece's origin.
    template <class Visit>
    void visit(std::size_t index, Visit&& visit) const {
        const Tile box = tile(index);
        for (std::uint32_t k = starts_[index]; k < starts_[index + 1]; ++k) {
            const RibbonPiece piece = pieceOf(items_[k]);
            visitPixels(piece, items_[k], box, visit);
        }
    }

  private:
    /// A curve point on the screen: both corners of the ribbon there.
    struct Projected {
        float x0 = 0, y0 = 0, x1 = 0, y1 = 0;
        float depth = 0;
        float coverage = -1;  ///< below 0: not before the eye
    };

    void project();
    void bin();
    RibbonPiece pieceOf(std::uint32_t item) const;

    template <class Visit>
    void visitPixels(const RibbonPiece& p, std::uint32_t item, const Tile& box, Visit&& visit) const {
        const float reach = window_.reach;
        const int lowX = box.left - p.originX;
        const int lowY = box.top - p.originY;
        const int highX = box.right - 1 - p.originX;
        const int highY = box.bottom - 1 - p.originY;
        const int fromU = p.steep ? lowY : lowX;
        const int toU = p.steep ? highY : highX;
        const int fromV = p.steep ? lowX : lowY;
        const int toV = p.steep ? highX : highY;
        const int u0 = max(static_cast<int>(ceil((p.steep ? p.minimum.y : p.minimum.x) - 0.5f - reach)), fromU);
        const int u1 = min(static_cast<int>(floor((p.steep ? p.maximum.y : p.maximum.x) - 0.5f + reach)), toU);
        for (int u = u0; u <= u1; ++u) {
            const float middle = p.start.y + p.slope * (static_cast<float>(u) + 0.5f - p.start.x);
            const int v0 = max(static_cast<int>(ceil(middle - p.across - 0.5f - reach)), fromV);
            const int v1 = min(static_cast<int>(floor(middle + p.across - 0.5f + reach)), toV);
            for (int v = v0; v <= v1; ++v) {
                const int x = p.steep ? v : u;
                const int y = p.steep ? u : v;
                visit(p, item, p.originX + x, p.originY + y, static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
            }
        }
    }

    std::vector<RibbonBatch> batches_;
    RibbonWindow window_;
    int across_ = 0, down_ = 0;
    std::vector<std::uint32_t> firstItems_;
    std::vector<Projected> projected_;   ///< one an item
    std::vector<std::uint32_t> items_;   ///< tile after tile
    std::vector<std::uint32_t> starts_;  ///< of each tile in them, then of all
};

}  // namespace hairloom::software
