// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace hairloom::render {

/// 8 bits a channel, sRGB, alpha not premultiplied; rows from the top, without gaps.
struct Image {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<std::uint8_t> rgba;
};

/// Linear RGB and coverage, before exposure and tone mapping; rows from the top, without gaps.
struct LinearImage {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<float> rgba;
};

/// What is nearest in the middle of a pixel; shaders::SurfacePixel is the same.
struct SurfacePixel {
    float depth = 0;                ///< metres along the view; infinite where nothing is
    std::uint32_t strand = 0;       ///< among those drawn; kNoStrand on a mesh and where nothing is
    float velocityX = 0;            ///< pixels that it has moved since a frame ago, to the right
    float velocityY = 0;            ///< and down
    std::array<float, 4> albedo{};  ///< linear RGB, and 0 where nothing is
    float pastDepth = 0;            ///< metres along the view of a frame ago
    std::array<float, 3> unused{};
    static constexpr std::uint32_t kNoStrand = 0xffffffffu;

    bool hasStrand() const { return strand != kNoStrand; }
};

}  // namespace hairloom::render
