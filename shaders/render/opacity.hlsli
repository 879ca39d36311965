// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HAIRLOOM_OPACITY_HLSLI
#define HAIRLOOM_OPACITY_HLSLI
// One whole fibre in a layer; 64 of them fill it.
#define OPACITY_UNIT (1.0 / 64.0)
// The same while fibres are being counted.
#define FIBRE_COUNT 65536.0

// Four 16-bit shares of 1, as a texel of RGBA16_UNORM holds them.
uint2 packShares(float4 share) {
    const uint4 s = uint4(saturate(share) * 65535.0 + 0.5);
    return s.xz | (s.yw << 16u);
}

float4 unpackShares(uint2 packed) {
    return float4(packed.x & 0xffffu, packed.x >> 16u, packed.y & 0xffffu, packed.y >> 16u) / 65535.0;
}

// Fibres in front of what lies `behind` metres behind the first hair: the layers of a deep opacity map, which end at `ends`.
float fibresInLayers(float4 layers, float3 ends, float behind) {
    const float3 begins = float3(0, ends.xy);
    return dot(layers.rgb, saturate((behind - begins) / (ends - begins))) / OPACITY_UNIT;
}

// Metres behind the near plane of a light's view; its range and near plane as in LightConstants.
float metresBehindNear(float depthRange, float nearPlane, float depth) {
    const float farPlane = nearPlane + depthRange;
    return nearPlane > 0 ? nearPlane * farPlane / (farPlane - depth * depthRange) - nearPlane : depth * depthRange;
}
#endif
