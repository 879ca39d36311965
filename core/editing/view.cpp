// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/view.h"

namespace hairloom::editing {

View::View(const Mat4f& view, const Mat4f& projection, const Vec2f& size_px)
    : view_(view),
      viewProjection_(projection * view),
      inverse_((projection.cast<double>() * view.cast<double>()).inverse().cast<float>()),
      size_(size_px),
      isPerspective_(projection(3, 3) == 0),
      scaleY_(projection(1, 1)) {
    const Mat3f rotation = view.topLeftCorner<3, 3>();
    eye_ = -rotation.transpose() * view.topRightCorner<3, 1>();
    forward_ = -rotation.row(2).transpose().normalized();
}

std::optional<ScreenPoint> View::project(const Vec3f& point_ss) const {
    const Vec4f clip = viewProjection_ * point_ss.homogeneous();
    const float depth = (point_ss - eye_).dot(forward_);
    constexpr float kNearest = 1e-6f;
    if (!(clip.w() > kNearest) || (isPerspective_ && !(depth > kNearest))) return std::nullopt;
    const Vec2f ndc = clip.head<2>() / clip.w();
    return ScreenPoint{Vec2f((ndc.x() + 1) * 0.5f * size_.x(), (1 - ndc.y()) * 0.5f * size_.y()), depth};
}

Ray View::rayAt(const Vec2f& px) const {
    const Vec2f ndc(2 * px.x() / size_.x() - 1, 1 - 2 * px.y() / size_.y());
    const auto at = [&](float depth) -> Vec3f {
        const Vec4f point = inverse_ * Vec4f(ndc.x(), ndc.y(), depth, 1);
        return point.head<3>() / point.w();
    };
    const Vec3f near = at(0);
    if (isPerspective_) return {eye_, (near - eye_).normalized()};
    return {near, forward_};
}

float View::metresPerPixel(float depth) const {
    return 2 * (isPerspective_ ? depth : 1.0f) / (scaleY_ * size_.y());
}

}  // namespace hairloom::editing
