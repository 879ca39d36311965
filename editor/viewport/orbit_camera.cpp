// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/viewport/orbit_camera.h"

#include <algorithm>
#include <cmath>

namespace hairloom::editor {
namespace {

constexpr float kFov = 28.0f;            // degrees
constexpr float kTurnPerPixel = 0.008f;  // radians
constexpr float kSteepest = 1.55f;

float halfTangent(float fov) {
    return std::tan(radians(fov) / 2);
}

}  // namespace

void OrbitCamera::turn(const QPointF& by_px) {
    yaw_ -= kTurnPerPixel * static_cast<float>(by_px.x());
    pitch_ = std::clamp(pitch_ + kTurnPerPixel * static_cast<float>(by_px.y()), -kSteepest, kSteepest);
}

void OrbitCamera::move(const QPointF& by_px, const QSizeF& view_px) {
    const float metres =
        2 * distance_ * halfTangent(kFov) / static_cast<float>(std::max(view_px.height(), 1.0));
    target_ws_ -=
        metres * (static_cast<float>(by_px.x()) * right_ws() - static_cast<float>(by_px.y()) * up_ws());
}

void OrbitCamera::zoom(float factor) {
    distance_ = std::clamp(distance_ / factor, 0.02f, 100.0f);
}

void OrbitCamera::spin(float degrees) {
    yaw_ += radians(degrees);
}

void OrbitCamera::look(render::View view) {
    constexpr float kQuarter = kPi / 2;
    pitch_ = 0;
    switch (view) {
        case render::View::Front:
            yaw_ = 0;
            break;
        case render::View::Back:
            yaw_ = kPi;
            break;
        case render::View::Left:
            yaw_ = kQuarter;
            break;
        case render::View::Right:
            yaw_ = -kQuarter;
            break;
        case render::View::ThreeQuarter:
            yaw_ = 0.6f;
            pitch_ = 0.1f;
            break;
        case render::View::Top:
            yaw_ = 0;
            pitch_ = kQuarter;
            break;
        case render::View::Bottom:
            yaw_ = 0;
            pitch_ = -kQuarter;
            break;
    }
}

void OrbitCamera::frame(const Box3f& bounds_ws, float aspect) {
    if (bounds_ws.isEmpty()) return;
    target_ws_ = bounds_ws.center();
    const float radius = std::max(0.5f * bounds_ws.diagonal().norm(), 0.01f);
    const float narrow = halfTangent(kFov) * std::min(1.0f, aspect);
    distance_ = std::clamp(radius / std::sin(std::atan(narrow)), 0.02f, 100.0f);
}

Vec3f OrbitCamera::forward_ws() const {
    return -Vec3f(std::sin(yaw_) * std::cos(pitch_), std::sin(pitch_), std::cos(yaw_) * std::cos(pitch_));
}
Vec3f OrbitCamera::right_ws() const {
    return {std::cos(yaw_), 0, -std::sin(yaw_)};
}
Vec3f OrbitCamera::up_ws() const {
    return right_ws().cross(forward_ws());
}

render::Camera OrbitCamera::camera() const {
    render::Camera camera;
    camera.verticalFov = kFov;
    if (orthographic_) camera.orthographicHeight = heightAtTarget();
    camera.target_ws = target_ws_;
    camera.eye_ws = target_ws_ - distance_ * forward_ws();
    camera.up_ws = up_ws();
    return camera;
}

float OrbitCamera::heightAtTarget() const {
    return 2 * distance_ * halfTangent(kFov);
}

Ray OrbitCamera::rayThrough(const QPointF& at_px, const QSizeF& view_px) const {
    const Vec3f eye = camera().eye_ws;
    const auto height = static_cast<float>(std::max(view_px.height(), 1.0));
    // In halves of the picture's height.
    const float x = (2 * static_cast<float>(at_px.x()) - static_cast<float>(view_px.width())) / height;
    const float y = (height - 2 * static_cast<float>(at_px.y())) / height;
    const Vec3f aside = x * right_ws() + y * up_ws();
    if (orthographic_) return {eye + 0.5f * heightAtTarget() * aside, forward_ws()};
    return {eye, (forward_ws() + halfTangent(kFov) * aside).normalized()};
}

std::optional<QPointF> OrbitCamera::project(const Vec3f& point_ws, const QSizeF& view_px) const {
    const Vec3f to = point_ws - camera().eye_ws;
    if (!orthographic_ && !(to.dot(forward_ws()) > 1e-4f)) return std::nullopt;
    const double scale = 1 / static_cast<double>(metresPerPixel(point_ws, view_px));
    return QPointF(view_px.width() / 2 + scale * static_cast<double>(to.dot(right_ws())),
                   view_px.height() / 2 - scale * static_cast<double>(to.dot(up_ws())));
}

float OrbitCamera::metresPerPixel(const Vec3f& point_ws, const QSizeF& view_px) const {
    return render::metresPerPixel(camera(), point_ws, static_cast<float>(std::max(view_px.height(), 1.0)));
}

}  // namespace hairloom::editor
