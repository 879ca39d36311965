// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "core/render/camera.h"

namespace hairloom::render {

/// A directional light.
struct Light {
    Vec3f toLight_ws = Vec3f(0.5f, 0.8f, 0.6f);       ///< need not be unit
    Vec3f irradiance = Vec3f::Constant(3.14159265f);  ///< linear RGB, perpendicular to the light
    bool castsShadow = true;
};

/// At most this many lights in a scene.
inline constexpr std::size_t kMaxLights = 3;

/// Errors: too many, no direction, a number that is not finite.
Status check(std::span<const Light> lights);

/// Key from the upper left, weaker fill from the right, rim from behind: as seen by the camera.
std::vector<Light> studioLights(const Camera& camera);

/// An orthographic view along the light that sees all of a box.
struct LightView {
    Mat4f clipFromWorld = Mat4f::Identity();
    float width = 1;       ///< metres across
    float depthRange = 1;  ///< metres between depth 0 and 1
};
LightView fitLight(const Vec3f& toLight_ws, const Box3f& bounds_ws);

}  // namespace hairloom::render
