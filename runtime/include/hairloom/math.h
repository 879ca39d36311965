// SPDX-License-Identifier: MIT
#pragma once
// The engine's own vectors: trivially copyable, laid out as float[3] and float[4], so that any caller's
// arrays of floats can be viewed as them. Metres, Y up, right-handed.

#include <cmath>
#include <type_traits>

namespace hairloom::runtime {

struct Float3 {
    float x = 0.0f;
    float y = 0.0f;
    float z = 0.0f;

    friend constexpr Float3 operator+(Float3 a, Float3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend constexpr Float3 operator-(Float3 a, Float3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend constexpr Float3 operator*(Float3 a, float s) { return {a.x * s, a.y * s, a.z * s}; }
    friend constexpr Float3 operator*(float s, Float3 a) { return a * s; }
    friend constexpr bool operator==(Float3, Float3) = default;
};

/// Rotation x·i + y·j + z·k + w, of unit length where a rotation is meant.
struct Quat {
    float x = 0.0f;
    float y = 0.0f;
    float z = 0.0f;
    float w = 1.0f;

    friend constexpr bool operator==(Quat, Quat) = default;
};

static_assert(sizeof(Float3) == 3 * sizeof(float) && std::is_trivially_copyable_v<Float3>);
static_assert(sizeof(Quat) == 4 * sizeof(float) && std::is_trivially_copyable_v<Quat>);

constexpr float dot(Float3 a, Float3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
constexpr Float3 cross(Float3 a, Float3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline float length(Float3 a) {
    return std::sqrt(dot(a, a));
}
inline bool isFinite(Float3 a) {
    return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

constexpr Quat conjugate(Quat q) {
    return {-q.x, -q.y, -q.z, q.w};
}
/// First b, then a.
constexpr Quat operator*(Quat a, Quat b) {
    return {a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
            a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}
constexpr Float3 rotate(Quat q, Float3 v) {
    const Float3 axis{q.x, q.y, q.z};
    const Float3 t = cross(axis, v) * 2.0f;
    return v + t * q.w + cross(axis, t);
}
/// False for a quaternion that is not finite or has no length to speak of.
inline bool normalize(Quat& q) {
    const float squared = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
    if (!(squared > 1e-12f) || !std::isfinite(squared)) return false;
    const float inverse = 1.0f / std::sqrt(squared);
    q = {q.x * inverse, q.y * inverse, q.z * inverse, q.w * inverse};
    return true;
}

}  // namespace hairloom::runtime
