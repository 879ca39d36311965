// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How hair shadows itself in all pictures of a groom. Plain data, as core/render/options.h has it for one
// picture.

#include <cstdint>

namespace hairloom {

/// How hair stands between a point and a light (render::Shadows).
enum class ShadowKind : std::uint32_t { deepOpacity, absorption, opacityMaps, adaptive, none };

/// Texels that are averaged (render::ShadowFilter).
enum class ShadowFiltering : std::uint32_t { off, three, five };

/// Where layers of deep opacity maps end (render::LayerEnds).
enum class ShadowLayerEnds : std::uint32_t { early, linear, growing };

/// Units, ranges and meanings stand in fieldsOf() (core/groom/file/fields.h).
struct ShadowSettings {
    ShadowKind kind = ShadowKind::deepOpacity;
    ShadowFiltering filter = ShadowFiltering::three;
    std::uint32_t resolution = 1024;
    std::uint32_t layers = 3;
    ShadowLayerEnds layerEnds = ShadowLayerEnds::early;
    float layerGrowth = 2.0f;
    std::uint32_t slices = 4;
    std::uint32_t nodes = 8;
    float headAbsorption = 0.0f;
    float blur = 0.0f;
};

}  // namespace hairloom
