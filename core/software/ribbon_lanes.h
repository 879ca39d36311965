// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Pixels of a tile that a piece of a ribbon covers, many at a time, with the instructions that this processor
// has. No sum is fused, so all processors find the same.

#include <array>
#include <cstdint>

namespace hairloom::software {

/// A piece of a ribbon between two points of a curve, in pixels from an origin. Lines are x and y of the
/// normal, then the offset; positive inside.
struct RibbonPiece {
    int originX = 0, originY = 0;
    std::array<float, 3> begins{}, ends{}, left{}, right{};
    float depthBegin = 0, depthEnd = 0;
    float coverageBegin = 0, coverageEnd = 0;
    /// Along its steeper direction u, where it begins, lies on and ends; v is across.
    float startU = 0, startV = 0, slope = 0, across = 0, lowU = 0, highU = 0;
    bool steep = false;  ///< u is y
};

/// Pixels, the last included.
struct PixelBox {
    int left = 0, top = 0, right = 0, bottom = 0;
};

/// What is found, in no particular order: no pixel twice.
struct RibbonHits {
    static constexpr std::size_t kMost = 1024;  ///< pixels of a box
    static constexpr std::size_t kSpare = 16;   ///< lanes written beyond
    std::size_t count = 0;
    std::array<float, kMost + kSpare> x, y;   ///< of the pixel, from the piece's origin
    std::array<float, kMost + kSpare> along;  ///< 0...1 from begin to end
    std::array<float, kMost + kSpare> depth;
    std::array<float, kMost + kSpare> inside;  ///< pixels from the nearer side
};

/// Of pixels whose middle lies between the ends and at most `reach` pixels outside. `box` has at most
/// RibbonHits::kMost pixels.
using FindHits = void (*)(const RibbonPiece& piece, const PixelBox& box, float reach, RibbonHits& hits);
FindHits findHits();

}  // namespace hairloom::software
