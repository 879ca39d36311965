// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HAIRLOOM_OPACITY_HLSLI
#define HAIRLOOM_OPACITY_HLSLI
// One whole fibre in a layer; 64 of them fill it.
#define OPACITY_UNIT (1.0 / 64.0)

// Metres behind the near plane of a light's view; `range` as in LightConstants.
float metresBehindNear(float4 range, float depth) {
    const float farPlane = range.z + range.x;
    return range.z > 0 ? range.z * farPlane / (farPlane - depth * range.x) - range.z : depth * range.x;
}
#endif
