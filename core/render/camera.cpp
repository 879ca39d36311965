// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/render/camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace hairloom::render {
namespace {

constexpr float kMargin = 1.08f;

Vec3f direction(View view) {
    switch (view) {
        case View::Front:
            return {0, 0.06f, 1};
        case View::Back:
            return {0, 0.06f, -1};
        case View::Left:
            return {1, 0.06f, 0};
        case View::Right:
            return {-1, 0.06f, 0};
        case View::Top:
            return Vec3f::UnitY();
        case View::Bottom:
            return -Vec3f::UnitY();
        case View::ThreeQuarter:
            break;
    }
    return {0.62f, 0.22f, 0.78f};
}

}  // namespace

Result<View> parseView(std::string_view name) {
    constexpr std::array<std::string_view, 7> kNames = {"front",         "back", "left",  "right",
                                                        "three-quarter", "top",  "bottom"};
    const auto found = std::ranges::find(kNames, name);
    if (found == kNames.end()) {
        return fail(fmt::format("no camera '{}'", name),
                    "front, back, left, right, three-quarter, top or bottom");
    }
    return static_cast<View>(found - kNames.begin());
}

float metresPerPixel(const Camera& camera, const Vec3f& point_ws, float height_px) {
    if (camera.isOrthographic()) return camera.orthographicHeight / height_px;
    constexpr float kNearest = 1e-4f;
    const Vec3f forward = (camera.target_ws - camera.eye_ws).normalized();
    const float depth = std::max((point_ws - camera.eye_ws).dot(forward), kNearest);
    return 2 * depth * std::tan(radians(camera.verticalFov) / 2) / height_px;
}

Camera frame(View view, const Box3f& bounds_ws, float aspect) {
    const Box3f box =
        bounds_ws.isEmpty() ? Box3f(Vec3f::Constant(-0.15f), Vec3f::Constant(0.15f)) : bounds_ws;
    Camera camera;
    camera.target_ws = box.center();
    const Vec3f back = direction(view).normalized();
    const bool isSteep = view == View::Top || view == View::Bottom;
    if (isSteep) camera.up_ws = (view == View::Top ? -1.0f : 1.0f) * Vec3f::UnitZ();
    const Vec3f right = camera.up_ws.cross(back).normalized();
    const Vec3f up = back.cross(right);
    const float tanY = std::tan(radians(camera.verticalFov) / 2);
    const float tanX = tanY * aspect;
    // The nearest distance from which every corner lies inside the frustum.
    float distance = 0.05f;
    for (int i = 0; i < 8; ++i) {
        const Vec3f corner = box.corner(static_cast<Box3f::CornerType>(i)) - camera.target_ws;
        const float needed = std::max(std::abs(corner.dot(right)) / tanX, std::abs(corner.dot(up)) / tanY);
        distance = std::max(distance, corner.dot(back) + kMargin * needed);
    }
    camera.eye_ws = camera.target_ws + back * distance;
    return camera;
}

Status check(const Camera& camera) {
    if (!camera.eye_ws.allFinite() || !camera.target_ws.allFinite() || !camera.up_ws.allFinite()) {
        return fail("the camera has a number that is not finite", "expected finite numbers");
    }
    const Vec3f forward = camera.target_ws - camera.eye_ws;
    if (!(forward.norm() > 0))
        return fail("the camera's eye and target are the same point", "expected two points");
    if (!(forward.normalized().cross(camera.up_ws.normalized()).norm() > 1e-4f)) {
        return fail("the camera's up direction lies along its view", "expected a direction across it");
    }
    if (!(camera.verticalFov >= 1 && camera.verticalFov <= 150)) {
        return fail(fmt::format("a field of view of {} degrees", camera.verticalFov), "1 to 150");
    }
    if (!(camera.orthographicHeight >= 0 && camera.orthographicHeight <= 1e6f)) {
        return fail(fmt::format("an orthographic view {} m high", camera.orthographicHeight), "0 to 1e6");
    }
    return {};
}

Mat4f viewMatrix(const Camera& camera) {
    const Vec3f back = (camera.eye_ws - camera.target_ws).normalized();
    const Vec3f right = camera.up_ws.cross(back).normalized();
    const Vec3f up = back.cross(right);
    Mat4f m = Mat4f::Identity();
    m.block<1, 3>(0, 0) = right.transpose();
    m.block<1, 3>(1, 0) = up.transpose();
    m.block<1, 3>(2, 0) = back.transpose();
    m.block<3, 1>(0, 3) = -(m.block<3, 3>(0, 0) * camera.eye_ws);
    return m;
}

Mat4f projectionMatrix(float verticalFovDegrees, float aspect, float nearPlane, float farPlane) {
    const float f = 1 / std::tan(radians(verticalFovDegrees) / 2);
    Mat4f m = Mat4f::Zero();
    m(0, 0) = f / aspect;
    m(1, 1) = f;
    m(2, 2) = farPlane / (nearPlane - farPlane);
    m(2, 3) = nearPlane * farPlane / (nearPlane - farPlane);
    m(3, 2) = -1;
    return m;
}

Mat4f projectionMatrix(const Camera& camera, float aspect, float nearPlane, float farPlane) {
    if (!camera.isOrthographic()) {
        return projectionMatrix(camera.verticalFov, aspect, nearPlane, farPlane);
    }
    Mat4f m = Mat4f::Identity();
    m(0, 0) = 2 / (camera.orthographicHeight * aspect);
    m(1, 1) = 2 / camera.orthographicHeight;
    m(2, 2) = 1 / (nearPlane - farPlane);
    m(2, 3) = nearPlane / (nearPlane - farPlane);
    return m;
}

}  // namespace hairloom::render
