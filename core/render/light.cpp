// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/render/light.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hairloom::render {
namespace {

constexpr float kMargin = 0.04f;       // of the size, around the hair
constexpr float kMinHalf = 1e-4f;      // metres
constexpr float kSizes = 8;            // of a light's view between one and twice as large
constexpr float kSnap = 64;            // texels along the side of the least map
constexpr float kWidestSlope = 3.73f;  // of a point light's view: tan 75 degrees

struct Extent {
    float minimum = std::numeric_limits<float>::max();
    float maximum = std::numeric_limits<float>::lowest();

    void add(float value) {
        minimum = std::min(minimum, value);
        maximum = std::max(maximum, value);
    }
    float size() const { return maximum - minimum; }
    /// Grows to a size of few, and to a place that moves by whole texels of any map of a multiple of kSnap
    /// texels, so that hair that rests meets the same texels while other hair moves.
    void snap() {
        const float least = std::max(size(), 2 * kMinHalf);
        const float step = std::exp2(std::floor(std::log2(least))) / kSizes;
        const float whole = std::ceil(least * (1 + 1.0f / kSnap) / step) * step;
        const float texels = whole / kSnap;
        minimum = std::floor(minimum / texels) * texels;
        maximum = minimum + whole;
    }
    void widen(float share) {
        const float by = std::max(share * size(), kMinHalf);
        minimum -= by;
        maximum += by;
    }
};

/// The middle of a box, on a grid that changes seldom while hair moves.
Vec3f roughly(const Box3f& box) {
    const float step = 0.25f * std::exp2(std::ceil(std::log2(std::max(box.diagonal().norm(), kMinHalf))));
    return ((box.center() / step).array().round() * step).matrix();
}

}  // namespace

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
    for (const Light& light : lights) {
        if (!light.position_ws.allFinite() || !light.intensity.allFinite() || !light.radiance.allFinite() ||
            !light.halfAcross_ws.allFinite() || !light.halfUp_ws.allFinite() ||
            !light.facing_ws.allFinite()) {
            return fail("a light with a number that is not finite", "expected finite numbers");
        }
        const bool isArea = light.kind == LightKind::rectangle || light.kind == LightKind::disc;
        if (isArea && !(light.halfAcross_ws.cross(light.halfUp_ws).norm() > 0))
            return fail("an area that gives off light and has no size", "expected sides with a length");
        if (!light.toLight_ws.allFinite() || !(light.toLight_ws.norm() > 0) ||
            !light.irradiance.allFinite()) {
            return fail("a light without a direction or with a colour that is not finite",
                        "expected a direction with a length, and finite numbers");
        }
    }
    return {};
}

LightView fitLight(const Light& light, std::span<const Vec3f> hair_ws, const Box3f& all_ws,
                   const Box3f& more_ws) {
    LightView view;
    const bool point = light.kind == LightKind::point;
    Box3f hair;
    for (const Vec3f& p : hair_ws) hair.extend(p);
    if (hair.isEmpty()) hair = Box3f(all_ws.center());
    // Towards the light; right and up span the shadow map.
    const Vec3f eye = point ? light.position_ws : Vec3f(Vec3f::Zero());
    const Vec3f out = point ? Vec3f(light.position_ws - roughly(hair)) : light.toLight_ws;
    const Vec3f back = out.norm() > 1e-6f ? out.normalized() : Vec3f::UnitY();
    const Vec3f helper = std::abs(back.y()) < 0.9f ? Vec3f::UnitY() : Vec3f::UnitX();
    const Vec3f right = helper.cross(back).normalized();
    const Vec3f up = back.cross(right);

    Extent across[2];
    Extent along;
    Extent hairAlong;
    const auto inView = [&](const Vec3f& p) {
        const Vec3f d = p - eye;
        return Vec3f(d.dot(right), d.dot(up), -d.dot(back));
    };
    for (const Vec3f& p : hair_ws) {
        const Vec3f v = inView(p);
        const float scale =
            point ? std::max({v.z(), v.head<2>().cwiseAbs().maxCoeff() / kWidestSlope, 1e-4f}) : 1;
        across[0].add(v.x() / scale);
        across[1].add(v.y() / scale);
        hairAlong.add(v.z());
    }
    if (hair_ws.empty()) {
        for (Extent& extent : across) extent = {-kMinHalf, kMinHalf};
        hairAlong.add(0);
    }
    for (int i = 0; i < 8 && !point && !more_ws.isEmpty(); ++i) {
        const Vec3f corner = inView(more_ws.corner(static_cast<Box3f::CornerType>(i)));
        for (int axis = 0; axis < 2; ++axis) across[axis].add(corner[axis]);
    }
    along = hairAlong;
    for (int i = 0; i < 8 && !all_ws.isEmpty(); ++i) {
        along.add(inView(all_ws.corner(static_cast<Box3f::CornerType>(i))).z());
    }
    for (Extent& extent : across) {
        extent.widen(kMargin);
        extent.snap();
    }
    along.widen(0.01f);
    along.snap();
    hairAlong.snap();
    if (point) along.minimum = std::max(along.minimum, std::max(1e-3f, 1e-4f * along.maximum));
    along.maximum = std::max(along.maximum, along.minimum + kMinHalf);

    view.eye_ws = point ? Vec4f(eye.x(), eye.y(), eye.z(), 1) : Vec4f(back.x(), back.y(), back.z(), 0);
    view.spread = std::max(across[0].size(), across[1].size());
    view.nearPlane = point ? along.minimum : 0;
    view.depthRange = along.size();
    view.hairStart = std::max(hairAlong.minimum - along.minimum, 0.0f);
    view.hairRange = std::max(hairAlong.size(), 1e-3f);

    Mat4f viewFromWorld = Mat4f::Identity();
    viewFromWorld.block<1, 3>(0, 0) = right.transpose();
    viewFromWorld.block<1, 3>(1, 0) = up.transpose();
    viewFromWorld.block<1, 3>(2, 0) = -back.transpose();
    viewFromWorld.block<3, 1>(0, 3) = -(viewFromWorld.block<3, 3>(0, 0) * eye);
    // x and y to -1…1, z (forward) to 0…1.
    Mat4f clip = Mat4f::Zero();
    for (int axis = 0; axis < 2; ++axis) {
        const Extent& e = across[axis];
        clip(axis, axis) = 2 / e.size();
        clip(axis, point ? 2 : 3) = -(e.minimum + e.maximum) / e.size();
    }
    if (point) {
        clip(2, 2) = along.maximum / along.size();
        clip(2, 3) = -along.minimum * along.maximum / along.size();
        clip(3, 2) = 1;
    } else {
        clip(2, 2) = 1 / along.size();
        clip(2, 3) = -along.minimum / along.size();
        clip(3, 3) = 1;
    }
    view.clipFromWorld = clip * viewFromWorld;
    return view;
}

}  // namespace hairloom::render
