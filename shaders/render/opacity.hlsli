// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HAIRLOOM_OPACITY_HLSLI
#define HAIRLOOM_OPACITY_HLSLI
#include "shaders/shared/render_types.h"

// One whole fibre in a layer; 64 of them fill it.
#define OPACITY_UNIT (1.0 / 64.0)
// The same while fibres are being counted.
#define FIBRE_COUNT 65536.0

// Ends of layer `i` of `count`, as parts of the depth that hair takes up. `growth`: how much wider each is than the one before; 0:
// early, at 0.04, 0.14 and 1 of three, each of which more cut evenly.
float layerEnd(uint i, uint count, float growth) {
    const float number = float(i + 1u);
    const float all = float(count);
    const float place = number / all;
    if (growth == 0.0)
        return place <= 1.0 / 3.0 ? 0.12 * place
               : place <= 2.0 / 3.0 ? 0.04 + 0.3 * (place - 1.0 / 3.0)
                                    : 0.14 + 2.58 * (place - 2.0 / 3.0);
    if (abs(growth - 1.0) < 1e-3) return place;
    return (pow(abs(growth), number) - 1.0) / (pow(abs(growth), all) - 1.0);
}

// The layer at a part of that depth; those behind the last belong to it.
uint layerAt(float part, uint count, float growth) {
    const float all = float(count);
    float place = part;
    if (growth == 0.0)
        place = part < 0.04 ? part / 0.12 : part < 0.14 ? 1.0 / 3.0 + (part - 0.04) / 0.3 : 2.0 / 3.0 + (part - 0.14) / 2.58;
    else if (abs(growth - 1.0) >= 1e-3)
        place = log(1.0 + max(part, 0.0) * (pow(abs(growth), all) - 1.0)) / (log(growth) * all);
    return uint(clamp(place * all, 0.0, all - 1.0));
}

// Four 16-bit shares of 1, as a texel of RGBA16_UNORM holds them.
uint2 packShares(float4 share) {
    const uint4 s = uint4(saturate(share) * 65535.0 + 0.5);
    return s.xz | (s.yw << 16u);
}

float4 unpackShares(uint2 packed) {
    return float4(packed.x & 0xffffu, packed.x >> 16u, packed.y & 0xffffu, packed.y >> 16u) * (1.0 / 65535.0);
}

// Fibres in front of a depth, as a texel of a deep opacity map tells; metres behind the near plane. The layers begin with the first
// hair and end map.layers.xyz metres behind it, the last where all hair ends. The first fibre, map.layers.w of a texel, stands where
// the first layer begins; the others are spread over theirs.
float fibresInLayers(LightConstants map, float4 layers, float depth) {
    const float first = (1.0 - layers.a) * map.depthRange;
    const float behind = depth - first;
    if (behind <= 0.0) return 0.0;
    const float3 counts = layers.rgb / OPACITY_UNIT;
    const float3 begins = float3(0, map.layers.xy);
    const float last = max(min(map.layers.z, map.hairBegins + map.layers.z - first), 1.01 * map.layers.y);
    const float3 parts = saturate((behind - begins) / (float3(map.layers.xy, last) - begins));
    return dot(counts, parts) + min(counts.x, map.layers.w) * (1.0 - parts.x);
}

// Metres behind the near plane of a light's view; its range and near plane as in LightConstants.
float metresBehindNear(float depthRange, float nearPlane, float depth) {
    const float farPlane = nearPlane + depthRange;
    return nearPlane > 0 ? nearPlane * farPlane / (farPlane - depth * depthRange) - nearPlane : depth * depthRange;
}

// By how many metres the depth of what runs along `along_ws` changes from texel to texel of a map, where it is at `uv` and `depth`:
// texels beside it are compared with that, or a fibre that leans towards the light would shade itself. 0 where it has no direction.
float2 depthSlope(LightConstants map, float3 position_ws, float3 along_ws, float2 uv, float depth) {
    if (dot(along_ws, along_ws) == 0.0) return float2(0, 0);
    const float kStep = 0.001;     // metres
    const float kSteepest = 4.0;  // metres a metre
    const float4 clip = mul(map.clipFromWorld, float4(position_ws + kStep * along_ws, 1));
    const float2 run = (float2(0.5 + 0.5 * clip.x / clip.w, 0.5 - 0.5 * clip.y / clip.w) - uv) * map.tileSize;
    const float rise = metresBehindNear(map.depthRange, map.nearPlane, clip.z / clip.w) - depth;
    const float2 slope = run * (rise / max(dot(run, run), 1e-4));
    return slope * min(1.0, kSteepest * map.texelSize / max(length(slope), 1e-12));
}
#endif
