// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HAIRLOOM_CURVE_HLSLI
#define HAIRLOOM_CURVE_HLSLI
#include "hash.hlsli"
#include "shaders/shared/render_types.h"

// Octahedral unit vectors (Cigolle et al. 2014) in two snorm16.
uint packUnit(float3 n) {
    const float2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    const float2 folded = (1.0 - abs(p.yx)) * float2(p.x >= 0 ? 1.0 : -1.0, p.y >= 0 ? 1.0 : -1.0);
    const float2 q = n.z >= 0 ? p : folded;
    const int2 i = int2(round(clamp(q, -1.0, 1.0) * 32767.0));
    return (uint(i.x) & 0xffffu) | (uint(i.y) << 16u);
}

float3 unpackUnit(uint packed) {
    const int2 i = int2(int(packed << 16u) >> 16, int(packed) >> 16);
    const float2 p = float2(i) / 32767.0;
    float3 n = float3(p, 1.0 - abs(p.x) - abs(p.y));
    const float t = saturate(-n.z);
    n.x += n.x >= 0 ? -t : t;
    n.y += n.y >= 0 ? -t : t;
    return normalize(n);
}
#endif
