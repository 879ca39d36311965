// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Depth of triangles, as a depth-only pass has it.

#include <array>
#include <cstdint>
#include <span>

namespace hairloom::software {

/// Part of a depth texture: a viewport of its own.
struct DepthWindow {
    std::span<float> depths;  ///< of the whole texture, rows from the top
    std::uint32_t width = 0;  ///< of the whole texture, pixels
    std::uint32_t left = 0, top = 0, columns = 0, rows = 0;
};

/// Keeps the least depth in the middle of each pixel. `clipFromWorld` is column-major; positions are three
/// floats a vertex, indices three a triangle. What lies before or behind depths of 0 to 1 is cut.
void drawDepth(const DepthWindow& window, const std::array<float, 16>& clipFromWorld,
               std::span<const float> positions, std::span<const std::uint32_t> indices);

}  // namespace hairloom::software
