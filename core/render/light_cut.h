// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What of a scene's light has a place in the shaders: any number of lights, areas and bright parts of images
// become at most so many directional and point lights, of which so many have shadow maps; what is left joins
// the light from around.

#include <span>
#include <vector>

#include "core/render/environment.h"
#include "core/render/light.h"

namespace hairloom::render {

struct LightBudget {
    std::uint32_t shadowed = 8;  ///< most lights with shadow maps, at least 1
    std::uint32_t all = 16;      ///< most lights
};

struct LightCut {
    std::vector<Light> lights;  ///< directional ones and points
    Environment rest;           ///< without bright parts
};

/// Lights that cast shadows take their place by the light that they bring to `centre_ws`, brightest first.
/// While there is room, the one whose light times its angular extent is the largest is cut in two: an area
/// across its longer side, a bright part of an image as Environment::fromImage() has it. The same input gives
/// the same lights.
LightCut cutLights(std::span<const Light> lights, const Environment& environment, const Vec3f& centre_ws,
                   const LightBudget& budget);

}  // namespace hairloom::render
