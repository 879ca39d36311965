// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/render/light.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace hairloom::render {

std::vector<Light> studioLights(const Camera& camera) {
    const Mat3f worldFromView = viewMatrix(camera).block<3, 3>(0, 0).transpose();
    const auto light = [&](const Vec3f& toLight_vs, const Vec3f& colour, float strength) {
        Light result;
        result.toLight_ws = (worldFromView * toLight_vs).normalized();
        result.irradiance = colour * (strength * kPi);
        return result;
    };
    return {light({-0.55f, 0.75f, 0.65f}, {1.0f, 0.95f, 0.88f}, 1.5f),
            light({0.85f, 0.15f, 0.60f}, {0.80f, 0.90f, 1.0f}, 0.42f),
            light({0.40f, 0.70f, -0.85f}, {1.0f, 0.97f, 0.92f}, 1.3f)};
}

Status check(std::span<const Light> lights) {
    if (lights.size() > kMaxLights) {
        return fail(fmt::format("{} lights", lights.size()), fmt::format("at most {}", kMaxLights));
    }
    for (const Light& light : lights) {
        if (!light.toLight_ws.allFinite() || !(light.toLight_ws.norm() > 0) ||
            !light.irradiance.allFinite()) {
            return fail("a light without a direction or with a colour that is not finite");
        }
    }
    return {};
}

LightView fitLight(const Vec3f& toLight_ws, const Box3f& bounds_ws) {
    const Vec3f back = toLight_ws.normalized();
    const Vec3f helper = std::abs(back.y()) < 0.9f ? Vec3f::UnitY() : Vec3f::UnitX();
    const Vec3f right = helper.cross(back).normalized();
    const Vec3f up = back.cross(right);
    const Vec3f centre = bounds_ws.center();
    float half = 0;
    float depth = 0;
    for (int i = 0; i < 8; ++i) {
        const Vec3f corner = bounds_ws.corner(static_cast<Box3f::CornerType>(i)) - centre;
        half = std::max({half, std::abs(corner.dot(right)), std::abs(corner.dot(up))});
        depth = std::max(depth, std::abs(corner.dot(back)));
    }
    half = std::max(half, 1e-4f);
    depth = std::max(depth, 1e-4f);
    LightView view;
    view.width = 2 * half;
    view.depthRange = 2 * depth;
    Mat4f& m = view.clipFromWorld;
    m.block<1, 3>(0, 0) = right.transpose() / half;
    m.block<1, 3>(1, 0) = up.transpose() / half;
    m.block<1, 3>(2, 0) = -back.transpose() / (2 * depth);
    m.block<3, 1>(0, 3) = -(m.block<3, 3>(0, 0) * centre);
    m(2, 3) += 0.5f;
    return view;
}

}  // namespace hairloom::render
