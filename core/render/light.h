// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "core/render/camera.h"

namespace hairloom::render {

enum class LightKind {
    directional,
    point,
    rectangle,  ///< gives off light evenly from one side
    disc,
};

struct Light {
    LightKind kind = LightKind::directional;
    Vec3f toLight_ws = Vec3f(0.5f, 0.8f, 0.6f);       ///< directional: need not be unit
    Vec3f irradiance = Vec3f::Constant(3.14159265f);  ///< directional: linear RGB, perpendicular to the light
    Vec3f position_ws = Vec3f(0, 2, 2);               ///< point, metres
    Vec3f intensity = Vec3f::Constant(3.14159265f);   ///< point: linear RGB irradiance at a distance of 1 m
    /// Of a point that is part of an area: unit, which way that faces; its light falls with the cosine. Zero:
    /// none.
    Vec3f facing_ws = Vec3f::Zero();
    /// Rectangle and disc around position_ws: from the middle to the right and to the upper edge, as one sees
    /// them whom they face.
    Vec3f halfAcross_ws = Vec3f(0.5f, 0, 0), halfUp_ws = Vec3f(0, 0.5f, 0);
    Vec3f radiance = Vec3f::Ones();  ///< linear RGB, likewise
    bool castsShadow = true;
};

/// At most this many lights are drawn one by one: cutLights().
inline constexpr std::size_t kMaxLights = 16;

/// Errors: no direction, an area without one, a number that is not finite.
Status check(std::span<const Light> lights);

/// Key from the upper left, weaker fill from the right, rim from behind: as seen by the camera.
std::vector<Light> studioLights(const Camera& camera);

/// The view from a light that its shadow map is drawn in: orthographic for a directional light, else
/// perspective.
struct LightView {
    Mat4f clipFromWorld = Mat4f::Identity();
    Vec4f eye_ws = Vec4f(0, 1, 0, 0);  ///< w = 0: direction towards the light; w = 1: its place
    float spread = 1;                  ///< metres across the longer side, at distance 1 of a point light
    float nearPlane = 0;               ///< metres from a point light; 0 for a directional one
    float depthRange = 1;              ///< metres between depth 0 and 1
    float hairStart = 0;               ///< metres behind the near plane where hair begins
    float hairRange = 1;               ///< metres along the light that hair takes up
};

/// Fitted, in steps that keep texels in their places while hair moves, to `hair_ws` across the light, and
/// along it to what throws shadows on hair or gets its shadow as well. A point light amidst the hair sees
/// only what lies within 75 degrees of the middle. A directional one sees `more_ws` as well.
LightView fitLight(const Light& light, std::span<const Vec3f> hair_ws, const Box3f& all_ws,
                   const Box3f& more_ws = {});

}  // namespace hairloom::render
