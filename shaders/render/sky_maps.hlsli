// SPDX-License-Identifier: GPL-3.0-or-later
// What stands between a place and the sky, as maps from twelve sides tell: the corners of an icosahedron, over which means
// are exact up to the fifth order.
#ifndef HAIRLOOM_SKY_MAPS_HLSLI
#define HAIRLOOM_SKY_MAPS_HLSLI
#include "shaders/render/opacity.hlsli"

cbuffer SkyMaps : register(b3) { SkyConstants gSkyMaps; };
Texture2D<float> gSkyHead : register(t18);
StructuredBuffer<uint> gSkyLayers : register(t19);  // two words a texel

// A line through a place, towards the side that a map is seen from and away from it.
struct SkyRay {
    float open;    // 1: the head does not hide the sky
    float before;  // fibres up to there
    float beyond;  // fibres on the other side, up to the head or where hair ends
    float ends;    // 1: the other side ends on the head
};

bool mapsTellTheSky(ShadeConstants shade) { return shade.hasSkyMaps > 0; }

// All or nothing would show the outline of each of the twelve shadows.
float openBehind(float behind) {
    const float kSoft = 0.02;  // metres
    return 1.0 - smoothstep(0.0, kSoft, behind);
}

// As occlusion() has them.
SkyRay skyRay(LightConstants map, float3 position_ws, float3 along_ws, float hairBias, float headBias) {
    SkyRay ray;
    ray.open = 1;
    ray.before = 0;
    ray.beyond = 0;
    ray.ends = 0;
    const float4 clip = mul(map.clipFromWorld, float4(position_ws, 1));
    const float size = map.tileSize;
    const float2 uv = float2(0.5 + 0.5 * clip.x, 0.5 - 0.5 * clip.y);
    const float2 place = uv * size - 0.5;
    // Towards the edge of what the map shows the sky opens.
    const float2 inside = min(place, size - 1.0 - place);
    const float known = saturate(0.25 * min(inside.x, inside.y));
    if (known <= 0.0) return ray;
    const int2 base = int2(floor(place));
    const float2 f = place - float2(base);
    const float depth = metresBehindNear(map.depthRange, map.nearPlane, clip.z);
    const float2 slope = depthSlope(map, position_ws, along_ws, uv, depth);
    const float ownBias = hairBias + 0.5 * (abs(slope.x) + abs(slope.y));
    const bool hair = map.shadows > 0.0;
    const bool head = map.headCasts > 0.0;
    float open = 0;
    float all = 0;
    [unroll] for (int y = 0; y < 2; ++y) {
        [unroll] for (int x = 0; x < 2; ++x) {
            const int2 at = base + int2(x, y);
            const float w = (x == 0 ? 1.0 - f.x : f.x) * (y == 0 ? 1.0 - f.y : f.y);
            const int column = at.x + int(map.tileLeft);
            float headDepth = map.depthRange;
            if (head) headDepth = metresBehindNear(map.depthRange, map.nearPlane, gSkyHead.Load(int3(column, at.y, 0)));
            if (hair) {
                const uint texel = 2u * (uint(at.y) * uint(map.atlasWidth) + uint(column));
                const float4 layers = unpackShares(uint2(gSkyLayers[texel], gSkyLayers[texel + 1u]));
                ray.before += w * fibresInLayers(map, layers, depth + dot(float2(at) - place, slope) - ownBias);
                all += w * fibresInLayers(map, layers, headDepth);
            }
            const float ends = headDepth < map.depthRange ? 1.0 : 0.0;
            open += w * lerp(1.0, openBehind(depth - headDepth - headBias), ends);
            ray.ends += w * ends;
        }
    }
    ray.open = lerp(1.0, open, known);
    ray.beyond = max(all - ray.before, 0.0);
    return ray;
}

// Shares of all directions around a place.
struct SkyShares {
    float open;      // see the sky
    float3 from;     // its mean direction, times 3
    float blocked;   // see the head
    float3 towards;  // its mean direction, times 3
};

SkyShares noShares() {
    SkyShares s;
    s.open = 0;
    s.from = 0;
    s.blocked = 0;
    s.towards = 0;
    return s;
}

void addRay(inout SkyShares s, SkyRay ray, float3 direction, float stopping) {
    const float each = 1.0 / float(HAIRLOOM_SKY_MAPS);
    const float open = each * ray.open * exp(-stopping * ray.before);
    const float blocked = each * ray.open * ray.ends * exp(-stopping * ray.beyond);
    s.open += open;
    s.from += 3.0 * open * direction;
    s.blocked += blocked;
    s.towards -= 3.0 * blocked * direction;
}

uint4 packSky(SkyShares s) {
    const uint2 open = packShares(float4(s.open, 0.5 + 0.5 * s.from));
    const uint2 blocked = packShares(float4(s.blocked, 0.5 + 0.5 * s.towards));
    return uint4(open, blocked);
}

SkyShares unpackSky(uint4 packed) {
    const float4 open = unpackShares(packed.xy);
    const float4 blocked = unpackShares(packed.zw);
    SkyShares s;
    s.open = open.x;
    s.from = 2.0 * open.yzw - 1.0;
    s.blocked = blocked.x;
    s.towards = 2.0 * blocked.yzw - 1.0;
    return s;
}

struct SkySeen {
    SkyShares whole, halved;
};

SkyShares between(SkyShares a, SkyShares b, float t) {
    SkyShares s;
    s.open = lerp(a.open, b.open, t);
    s.from = lerp(a.from, b.from, t);
    s.blocked = lerp(a.blocked, b.blocked, t);
    s.towards = lerp(a.towards, b.towards, t);
    return s;
}

// At a curve point, between the points that the strand was given with.
SkySeen seenAt(StructuredBuffer<SkyPoint> points, StrandHeader strand, uint place, uint curvePoint, uint subdivisions) {
    const uint along = curvePoint - strand.segmentsBefore * subdivisions - place;
    const uint k = min(along / subdivisions, strand.pointCount - 2u);
    const float t = float(along - k * subdivisions) / float(subdivisions);
    const SkyPoint a = points[strand.segmentsBefore + place + k];
    const SkyPoint b = points[strand.segmentsBefore + place + k + 1u];
    SkySeen seen;
    seen.whole = between(unpackSky(a.whole), unpackSky(b.whole), t);
    seen.halved = between(unpackSky(a.halved), unpackSky(b.halved), t);
    return seen;
}

// What a place in a fibre sees, without so many metres of hair around it.
SkyPoint skySeen(float3 position_ws, float3 along_ws, float bias) {
    SkyShares whole = noShares();
    SkyShares halved = noShares();
    for (uint i = 0; i < HAIRLOOM_SKY_MAPS; ++i) {
        const LightConstants map = gSkyMaps.maps[i];
        const SkyRay ray = skyRay(map, position_ws, along_ws, bias, 0.002 + 2.0 * map.texelSize);
        addRay(whole, ray, map.toLight_ws.xyz, map.stopping);
        addRay(halved, ray, map.toLight_ws.xyz, 0.5 * map.stopping);
    }
    SkyPoint seen;
    seen.whole = packSky(whole);
    seen.halved = packSky(halved);
    return seen;
}
#endif
