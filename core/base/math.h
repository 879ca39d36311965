// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The vector types of the application. Metres, Y up, right-handed; see docs/formats for the borders.

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace hairloom {

using Vec2f = Eigen::Vector2f;
using Vec3f = Eigen::Vector3f;
using Vec4f = Eigen::Vector4f;
using Vec2d = Eigen::Vector2d;
using Vec3d = Eigen::Vector3d;
using Mat3f = Eigen::Matrix3f;
using Mat4f = Eigen::Matrix4f;
using Quatf = Eigen::Quaternionf;
using Box3f = Eigen::AlignedBox3f;

inline constexpr float kPi = 3.14159265358979323846f;

inline constexpr float radians(float degrees) {
    return degrees * (kPi / 180.0f);
}
inline constexpr float degrees(float radians) {
    return radians * (180.0f / kPi);
}

}  // namespace hairloom
