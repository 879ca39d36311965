// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

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

}  // namespace hairloom::render
