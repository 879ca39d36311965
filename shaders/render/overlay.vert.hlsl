// SPDX-License-Identifier: GPL-3.0-or-later
// Marks over the picture: each point or line becomes a square of two triangles, a pixel wider than the mark so that
// its edges can fade.
#include "shaders/shared/render_types.h"

cbuffer Constants : register(b0) { OverlayConstants gOverlay; };
StructuredBuffer<OverlayVertex> gVertices : register(t0);

struct Output {
    float4 position : SV_Position;
    float4 colour : COLOR;
    noperspective float2 offset : OFFSET;        // pixels from the middle of the mark
    nointerpolation float halfLength : HALFSIZE;  // pixels from the middle of a line to its ends
};

// Towards the eye by this part of the distance, so that marks on a surface are not lost in it.
static const float kLift = 0.002;
static const float kNear = 1e-4;

float4 toClip(OverlayVertex v) {
    float4 clip = mul(gOverlay.clipFromWorld, float4(v.position_ws.xyz, 1));
    clip.z -= kLift * abs(clip.w) * (1.0 - saturate(clip.z / max(clip.w, 1e-6)));
    return clip;
}

Output main(uint id : SV_VertexID) {
    Output o;
    o.offset = 0;
    o.halfLength = 0;
    const float2 halfView = 0.5 * float2(gOverlay.width, gOverlay.height);
    if (gOverlay.shape == 2u) {
        const OverlayVertex v = gVertices[gOverlay.firstVertex + id];
        o.position = toClip(v);
        o.colour = v.colour;
        return o;
    }
    const uint mark = id / 6u;
    const uint corner = id - 6u * mark;
    // Corners 0 1 2, 2 1 3 of the square.
    const uint place = corner < 3u ? corner : (corner == 3u ? 2u : (corner == 4u ? 1u : 3u));
    const float2 side = float2((place & 1u) != 0u ? 1.0 : -1.0, (place & 2u) != 0u ? 1.0 : -1.0);
    const float reach = gOverlay.markRadius + 1.0;
    if (gOverlay.shape == 0u) {
        const OverlayVertex v = gVertices[gOverlay.firstVertex + mark];
        const float4 clip = toClip(v);
        o.colour = v.colour;
        o.offset = side * reach;
        o.position = clip + float4(o.offset / halfView * clip.w, 0, 0);
        return o;
    }
    const OverlayVertex first = gVertices[gOverlay.firstVertex + 2u * mark];
    const OverlayVertex second = gVertices[gOverlay.firstVertex + 2u * mark + 1u];
    float4 a = toClip(first);
    float4 b = toClip(second);
    float4 colourA = first.colour;
    float4 colourB = second.colour;
    // What lies behind the eye has no place on the screen: lines end where they come near it.
    if (a.w < kNear && b.w < kNear) {
        o.position = float4(2, 2, 2, 1);
        o.colour = 0;
        return o;
    }
    const float cut = (kNear - a.w) / (b.w - a.w);
    if (a.w < kNear) {
        a = lerp(a, b, cut);
        colourA = lerp(colourA, colourB, cut);
    } else if (b.w < kNear) {
        b = lerp(a, b, cut);
        colourB = lerp(colourA, colourB, cut);
    }
    const float2 screenA = a.xy / a.w * halfView;
    const float2 screenB = b.xy / b.w * halfView;
    const float2 along = screenB - screenA;
    const float lineLength = length(along);
    const float2 direction = lineLength > 1e-6 ? along / lineLength : float2(1, 0);
    const float2 across = float2(-direction.y, direction.x);
    const bool end = side.x > 0;
    const float4 clip = end ? b : a;
    o.halfLength = 0.5 * lineLength;
    o.offset = float2(side.x * (o.halfLength + reach), side.y * reach);
    o.colour = end ? colourB : colourA;
    const float2 moved = direction * (side.x * reach) + across * (side.y * reach);
    o.position = float4(clip.xy + moved / halfView * clip.w, clip.z, clip.w);
    return o;
}
