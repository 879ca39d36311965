// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Maps of what stands in the way of light: those of the lights that cast shadows, and those of the sky.

#include "core/render/passes.h"

namespace hairloom::render {

/// Squares side by side, each a view of head and hair.
struct ShadowAtlas {
    std::vector<const LightView*> views;  ///< from left to right
    std::uint32_t side = 1;               ///< texels of a square
    Shadows shadows = Shadows::none;      ///< how hair is in it
    float share = 1;                      ///< of the strands, each counted as so many more
    std::uint32_t layerCount = 3;         ///< of opacity
    float growth = 0;                     ///< of layers: growthOf()
    std::size_t close = 0;                ///< of the last views, parts of others
    float filterTexels = 3;               ///< a side of what is averaged
    TargetId head = TargetId::headDepth;
    BufferId first = BufferId::firstHair, counts = BufferId::layerCounts, layers = BufferId::opacity;
    Pass headPass = Pass::headDepth, firstPass = Pass::firstHair, layersPass = Pass::opacity;

    std::uint32_t left(std::size_t square) const { return static_cast<std::uint32_t>(square) * side; }
    std::uint32_t width() const { return left(views.size()); }
};

/// Views from the lights; of the `sky` too, with their constants, where the plan has maps of it.
void fitViews(RendererState& state, bool sky);

/// Of the lights that cast shadows, in their order; then the close maps that are placed.
ShadowAtlas lightAtlas(const RendererState& state);
/// Of the sky: hair, and what of the head is near it.
ShadowAtlas skyAtlas(const RendererState& state);

/// As shaders look into a square of the atlas.
shaders::LightConstants mapConstants(const RendererState& state, const ShadowAtlas& atlas,
                                     std::size_t square);
/// A light as shaders have it, with its map where it casts shadows, and the number of its close map where it
/// has one.
shaders::LightConstants lightConstants(const RendererState& state, std::size_t light);
/// A close map; 0…closeViews.size() − 1.
shaders::LightConstants closeMapConstants(const RendererState& state, std::size_t map);

/// Draws what the plan has of the atlas.
void recordMaps(gpu::CommandList& list, RendererState& state, const ShadowAtlas& atlas);

}  // namespace hairloom::render
