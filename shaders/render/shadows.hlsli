// SPDX-License-Identifier: GPL-3.0-or-later
// What stands between a point and a light: the head (a depth map) and fibres (one of four kinds of maps).
#ifndef HAIRLOOM_SHADOWS_HLSLI
#define HAIRLOOM_SHADOWS_HLSLI
#include "shaders/render/lights.hlsli"
#include "shaders/render/adaptive.hlsli"
#include "shaders/render/opacity.hlsli"

Texture2D<float> gHeadDepth : register(t8);
StructuredBuffer<uint> gFirstHair : register(t9);  // depths as bits
StructuredBuffer<uint> gOpacity : register(t10);    // two words a texel, or more where there are more layers; or nodes

static const float kSkinPatch = 0.05;  // metres: radius of skin that is lit alike

struct Occlusion {
    float fibres;      // crossed on the way to the light
    float passed;      // share of the light that meets none of them: what single texels let through, for hair has gaps
    // The same two as the finest map has them: hair near the camera shades its neighbours sharply. What other fibres scatter comes
    // from around, and asks for the mean of more hair.
    float directFibres, direct;
    float allFibres;   // from the hair's lit side to its other, or to the head
    float visibility;  // 0 behind the head ... 1
    float ends;        // 1 where the light's way ends on the head
    float ground;      // share of the light that the head, where the light's way ends on it, can send back here
};

// What a light of its own shadows: nothing where shadows are left out. Light from around is still kept off.
Occlusion shadowOf(LightConstants light, Occlusion o) {
    if (light.withoutShadows == 0.0) return o;
    o.fibres = o.directFibres = 0.0;
    o.passed = o.direct = 1.0;
    o.visibility = 1.0;
    return o;
}

// Share `i` of 1, of those that begin at a word.
float shareAt(uint word, uint i) {
    return float((gOpacity[word + i / 2u] >> (16u * (i & 1u))) & 0xffffu) * (1.0 / 65535.0);
}

// fibresInLayers(), or fibres in slices at fixed depths, of any number of layers.
float fibresInManyLayers(LightConstants light, uint texel, float depth) {
    const bool fixedLayers = uint(light.shadows) == HAIRLOOM_SHADOWS_OPACITY_MAPS;
    const uint count = uint(light.layerCount);
    const uint words = 2u * ((count + (fixedLayers ? 0u : 1u) + 3u) / 4u);
    const uint word = words * texel;
    const float range = fixedLayers ? light.layers.w : light.layers.z;
    const float starts = fixedLayers ? light.hairBegins : (1.0 - shareAt(word, 2u * words - 1u)) * light.depthRange;
    const float behind = depth - starts;
    if (behind <= 0.0) return 0.0;
    float fibres = 0.0;
    float begins = 0.0;
    for (uint i = 0u; i < count && begins < behind; ++i) {
        float ends = range * layerEnd(i, count, light.layerGrowth);
        if (!fixedLayers && i + 1u == count) ends = max(min(range, light.hairBegins + range - starts), 1.01 * begins);
        const float part = saturate((behind - begins) / (ends - begins));
        const float inLayer = shareAt(word, i) / OPACITY_UNIT;
        fibres += inLayer * part;
        if (!fixedLayers && i == 0u) fibres += min(inLayer, light.layers.w) * (1.0 - part);
        begins = ends;
    }
    return fibres;
}

// Fibres in front of a depth, on the line through a texel's nodes.
float fibresInNodes(LightConstants light, uint texel, float depth) {
    const uint count = uint(light.layerCount);
    const float part = depth / light.depthRange;
    float2 before = float2(0, 0);
    for (uint i = 0u; i < count; ++i) {
        const float2 node = unpackNode(gOpacity[count * texel + i]);
        if (part < node.x) {
            if (i == 0u) return 0.0;
            const float along = (part - before.x) / (node.x - before.x);
            return -2.0 * log(lerp(lightBehind(before.y), lightBehind(node.y), along));
        }
        before = node;
    }
    return before.y;
}

// Fibres in front of a depth, as one texel of a map tells; `bias` metres of them are left out.
float fibresAt(LightConstants light, uint texel, float depth, float bias) {
    const uint mode = uint(light.shadows);
    if (mode == HAIRLOOM_SHADOWS_ABSORPTION) {
        // Dachsbacher and Stamminger 2003 for hair: evenly spread, up to as many as there are from side to side.
        const float behind = depth - metresBehindNear(light.depthRange, light.nearPlane, asfloat(gFirstHair[texel])) - bias;
        return light.layers.y * (1.0 - exp(-max(behind, 0.0) * light.layers.x / max(light.layers.y, 1e-6)));
    }
    if (mode == HAIRLOOM_SHADOWS_ADAPTIVE) return fibresInNodes(light, texel, depth - bias);
    if (uint(light.layerCount) != (mode == HAIRLOOM_SHADOWS_OPACITY_MAPS ? 4u : 3u)) return fibresInManyLayers(light, texel, depth - bias);
    const float4 layers = unpackShares(uint2(gOpacity[2u * texel], gOpacity[2u * texel + 1u]));
    if (mode == HAIRLOOM_SHADOWS_OPACITY_MAPS) {
        const float4 begins = float4(0, light.layers.xyz);
        const float4 part = saturate((depth - bias - light.hairBegins - begins) / (light.layers - begins));
        return dot(layers, part) / OPACITY_UNIT;
    }
    return fibresInLayers(light, layers, depth - bias);
}

// What the head leaves of the light at `behind` metres behind its first surface: all or nothing, or with `absorption` as
// light fades in translucent stuff (Dachsbacher and Stamminger 2003; Rünz 2012, section 6.3).
float throughHead(float behind, float absorption) {
    if (absorption > 0.0) return exp(-absorption * max(behind, 0.0));
    return behind < 0.0 ? 1.0 : 0.0;
}

// Weight of texel `i` of a B-spline over 1, 3 or 5 texels, of which the middle of the first is at `f` from 0 to 1 before the
// place's own.
float splineWeight(int texels, int i, float f) {
    const float g = 1.0 - f;
    if (texels == 1) return 1.0;
    if (texels == 3) return i == 0 ? 0.5 * g * g : i == 1 ? 0.5 + f * g : 0.5 * f * f;
    const float a = i > 2 ? f : g;  // it is symmetric
    if (i == 0 || i == 4) return a * a * a * a / 24.0;
    if (i == 2) return (11.0 + f * (12.0 + f * (-6.0 + f * (-12.0 + 6.0 * f)))) / 24.0;
    return (1.0 + a * (4.0 + a * (6.0 + a * (4.0 - 4.0 * a)))) / 24.0;
}

// As one map has it. Biases: metres towards the light, so that a surface does not shadow itself. `along_ws`: of a fibre there, or 0.
// `headAbsorption`: see throughHead().
Occlusion occlusionInMap(LightConstants light, float3 position_ws, float3 along_ws, float hairBias, float headBias,
                         float headAbsorption) {
    Occlusion result;
    result.fibres = result.directFibres = 0;
    result.passed = result.direct = 1;
    result.allFibres = 0;
    result.visibility = 1;
    result.ends = 0;
    result.ground = 0;
    const float4 clip = mul(light.clipFromWorld, float4(position_ws, 1));
    const bool hair = light.shadows > 0;
    const bool head = light.headCasts > 0;
    if (!(hair || head) || clip.w <= 0) return result;
    const float2 uv = float2(0.5 + 0.5 * clip.x / clip.w, 0.5 - 0.5 * clip.y / clip.w);
    if (any(uv < 0.0) || any(uv > 1.0)) return result;
    const int size = int(light.tileSize);
    // A B-spline over 3 x 3 texels of finished comparisons, or as many as are wanted, from `base` on: its mean is half a texel
    // further than the middle of base + f, and so are the middles of texels.
    const int texels = int(light.filterTexels);
    const int reach = int(uint(texels) / 2u);
    // Hairs that stand for several are wider than texels. Texels as far from each other as such hairs are wide are averaged, and
    // then let light through by the mean of their fibres: what all hairs would do, which hardly differ from texel to texel.
    const bool spread = light.tapDistance > 1.0;
    const float step = max(light.tapDistance, 1.0);
    const float2 place = uv * (light.tileSize / step) - float(reach);
    const int2 base = int2(floor(place));
    const float2 f = place - float2(base);
    const float depth = metresBehindNear(light.depthRange, light.nearPlane, clip.z / clip.w);
    const float2 slope = depthSlope(light, position_ws, along_ws, uv, depth);
    const float ownBias = hairBias + 0.5 * (abs(slope.x) + abs(slope.y));
    const float turns = texels == 5 ? 50.0 : 6.0;  // sum of the squares of what follows as `rise`
    float fibres = 0;
    float passed = 0;
    float visible = 0;
    float all = 0;
    float ends = 0;
    float behind = 0;   // metres of the head behind the point
    float2 rise = 0;    // of the head's depth from texel to texel
    for (int y = 0; y < texels; ++y) {
        const float wy = splineWeight(texels, y, f.y);
        for (int x = 0; x < texels; ++x) {
            const int2 tap = spread ? int2(floor((float2(base + int2(x, y)) + 0.5) * step)) : base + int2(x, y);
            const int2 at = clamp(tap, int2(0, 0), int2(size - 1, size - 1));
            const int3 where = int3(at.x + int(light.tileLeft), at.y, 0);
            const uint texel = uint(at.y) * uint(light.atlasWidth) + uint(where.x);
            const float w = splineWeight(texels, x, f.x) * wy;
            const float headDepth = metresBehindNear(light.depthRange, light.nearPlane, head ? gHeadDepth.Load(where) : 1.0);
            if (hair) {
                const float2 beside = float2(tap) + 0.5 - uv * light.tileSize;
                const float crossed = fibresAt(light, texel, depth + dot(beside, slope), ownBias);
                fibres += w * crossed;
                passed += w * exp(-light.stopping * crossed);
                all += w * fibresAt(light, texel, headDepth, 0);
            }
            if (head) {
                visible += w * throughHead(depth - headDepth - headBias, headAbsorption);
                ends += w * (headDepth < light.depthRange ? 1.0 : 0.0);
                behind += w * max(headDepth - depth, 0.0);
                rise += float2(x - reach, y - reach) * (headDepth / turns);
            }
        }
    }
    result.fibres = result.directFibres = fibres;
    if (light.tapDistance > 0.0) passed = lerp(passed, exp(-light.stopping * fibres), min(light.tapDistance, 1.0));
    result.passed = result.direct = hair ? passed : 1.0;
    result.allFibres = max(all, fibres);
    result.visibility = head ? visible : 1.0;
    // A slope gets less light on its area; and from afar the lit skin is a smaller part of what lies around.
    const float texelSize = light.texelSize * step;
    const float facing = texelSize * rsqrt(texelSize * texelSize + dot(rise, rise));
    result.ends = ends;
    result.ground = ends * facing * kSkinPatch * kSkinPatch / (kSkinPatch * kSkinPatch + behind * behind);
    return result;
}

// How much of the light at a place the light's close map tells: less where that ends.
float closeShareAt(LightConstants light, LightConstants close, float3 position_ws) {
    if (light.closeShare == 0.0) return 0.0;
    const float4 clip = mul(close.clipFromWorld, float4(position_ws, 1));
    if (clip.w <= 0.0) return 0.0;
    const float2 outwards = abs(clip.xy / clip.w);
    return light.closeShare * saturate(8.0 * (1.0 - max(outwards.x, outwards.y)));
}

// Likewise, by the map of the whole light, and what is sharp by `close`, the light's close map, where it has one.
Occlusion occlusion(LightConstants light, LightConstants close, float3 position_ws, float3 along_ws, float hairBias, float headBias,
                    float headAbsorption) {
    Occlusion result = occlusionInMap(light, position_ws, along_ws, hairBias, headBias, headAbsorption);
    const float share = closeShareAt(light, close, position_ws);
    if (share > 0.0) {
        const Occlusion finer = occlusionInMap(close, position_ws, along_ws, hairBias, headBias, headAbsorption);
        result.directFibres = lerp(result.fibres, finer.fibres, share);
        result.direct = lerp(result.passed, finer.passed, share);
        result.visibility = lerp(result.visibility, finer.visibility, share);
    }
    return result;
}
#endif
