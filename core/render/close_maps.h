// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Shadow maps of what is near the camera, beside those of whole lights, where single hairs
// can be told apart: they then throw the sharp shadows on each other that make their contrast.

#include <cstdint>

#include "core/gpu/types.h"
#include "core/render/options.h"

namespace hairloom::render {

struct RendererState;

/// How many such maps a device has room for beside `lights` maps of whole lights, at most
/// HAIRLOOM_CLOSE_MAPS; none for kinds of shadows that do not tell single hairs apart.
std::uint32_t closeMapsThatFit(const RenderOptions& options, const gpu::DeviceInfo& device,
                               std::uint32_t lights);

/// Hair where the camera sees it first, and how much of what tells single hairs apart shows there: it comes
/// gradually, so that nothing pops.
struct CloseHair {
    float maps = 0;      ///< of the light by close maps: from 0.4 pixels that a hair is wide to all at 0.6
    float across = 0;    ///< of the light's change over the width of a hair: from 1 pixel to 1.5
    float distance = 0;  ///< metres before the eye; without perspective it may be behind

    bool operator==(const CloseHair&) const = default;
};

/// Nothing where much hair is left out for its distance, and where strands are drawn as tubes.
CloseHair closeHairOf(const RendererState& state);

/// Places the maps that the plan has over what the camera sees, each within its light's view, in steps, so
/// that they seldom move while the camera does. fitViews() comes before. True: they lie elsewhere than
/// before, and have to be drawn.
bool placeCloseMaps(RendererState& state);

}  // namespace hairloom::render
