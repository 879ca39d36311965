// SPDX-License-Identifier: GPL-3.0-or-later
// One thread draws the piece of a ribbon between two points of a curve: the quadrilateral that the strip has there. What
// includes this says in visitPixel() what becomes of a pixel that the piece may touch. Pieces that reach behind the eye
// are left out.
#include "shaders/render/raster.hlsli"
#include "shaders/render/ribbon.hlsli"

cbuffer Constants : register(b0) { ViewConstants gView; };
StructuredBuffer<CurvePoint> gCurve : register(t0);

struct RibbonPiece {
    uint first;  // of its two curve points
    uint strand;
    int2 origin;  // pixel that places below count from, which keeps them exact
    // Lines around it, in pixels: positive inside.
    float3 begins, ends, left, right;
    float2 depth;     // at begin and end
    float2 coverage;  // likewise
};

void visitPixel(RibbonPiece piece, int2 pixel);

// Positive to the right of the way from a to b, y down; in pixels from the line.
float3 lineThrough(float2 a, float2 b) {
    const float2 d = b - a;
    const float2 n = float2(-d.y, d.x) * rsqrt(max(dot(d, d), 1e-20));
    return float3(n, -dot(n, a));
}

float distanceTo(float3 border, float2 at) { return dot(border.xy, at) + border.z; }

// Where between begin and end, 0 to 1, or below 0 outside. `at` counts from the piece's origin.
float placeOn(RibbonPiece piece, float2 at) {
    const float after = distanceTo(piece.begins, at);
    const float before = distanceTo(piece.ends, at);
    const bool inside =
        after >= 0.0 && before > 0.0 && distanceTo(piece.left, at) >= 0.0 && distanceTo(piece.right, at) > 0.0;
    return inside ? after / (after + before) : -1.0;
}

// The same without the ends: held to 0 to 1.
float alongPiece(RibbonPiece piece, float2 at) {
    const float after = max(distanceTo(piece.begins, at), 0.0);
    const float before = max(distanceTo(piece.ends, at), 0.0);
    return after / max(after + before, 1e-12);
}

float pixelsAcross(RibbonPiece piece, float2 at) { return max(distanceTo(piece.left, at) + distanceTo(piece.right, at), 1e-6); }

// From the first side, -1, to the second, 1.
float placeAcross(RibbonPiece piece, float2 at) {
    return (distanceTo(piece.left, at) - distanceTo(piece.right, at)) / pixelsAcross(piece, at);
}

float2 fromOrigin(RibbonPiece piece, int2 pixel) { return float2(pixel - piece.origin) + 0.5; }

// All pixels near the middle line, row by row across its steeper direction.
void visitPixels(RibbonPiece piece, float2 a0, float2 a1, float2 b0, float2 b1) {
    const float2 a = 0.5 * (a0 + a1);
    const float2 d = 0.5 * (b0 + b1) - a;
    const bool steep = abs(d.y) > abs(d.x);
    const float2 minimum = min(min(a0, a1), min(b0, b1));
    const float2 maximum = max(max(a0, a1), max(b0, b1));
    const float run = steep ? d.y : d.x;
    const float slope = abs(run) > 1e-6 ? (steep ? d.x : d.y) / run : 0.0;
    const float halfWidth = 0.5 * max(length(a1 - a0), length(b1 - b0));
    const float reach = gRaster.sampleReach;
    const float across = halfWidth * sqrt(1.0 + slope * slope) + reach * abs(slope);
    const float2 start = steep ? a.yx : a;
    const int2 low = int2(gRaster.window.xy) - piece.origin;
    const int2 high = low + int2(gRaster.window.zw) - 1;
    const int2 from = steep ? low.yx : low;
    const int2 to = steep ? high.yx : high;
    const int u0 = max(int(ceil((steep ? minimum.y : minimum.x) - 0.5 - reach)), from.x);
    const int u1 = min(int(floor((steep ? maximum.y : maximum.x) - 0.5 + reach)), to.x);
    for (int u = u0; u <= u1; ++u) {
        const float middle = start.y + slope * (float(u) + 0.5 - start.x);
        const int v0 = max(int(ceil(middle - across - 0.5 - reach)), from.y);
        const int v1 = min(int(floor(middle + across - 0.5 + reach)), to.y);
        for (int v = v0; v <= v1; ++v) visitPixel(piece, piece.origin + (steep ? int2(v, u) : int2(u, v)));
    }
}

[numthreads(HAIRLOOM_LIST_GROUP, 1, 1)]
void main(uint3 id : SV_DispatchThreadID) {
    const uint index = id.x + id.y * gRaster.rowLength;
    if (id.x >= gRaster.rowLength || index + 1u >= gRaster.count) return;
    const CurvePoint p = gCurve[index];
    const CurvePoint q = gCurve[index + 1u];
    if (p.strand != q.strand) return;
    const RibbonCorner a0 = ribbonCorner(gView, p, false);
    const RibbonCorner a1 = ribbonCorner(gView, p, true);
    const RibbonCorner b0 = ribbonCorner(gView, q, false);
    const RibbonCorner b1 = ribbonCorner(gView, q, true);
    const float nearest = min(min(a0.position.w, a1.position.w), min(b0.position.w, b1.position.w));
    if (nearest <= 1e-6 || max(a0.coverage, b0.coverage) <= 0.0) return;
    const float2 onto[4] = {onBuffer(a0.position), onBuffer(a1.position), onBuffer(b0.position), onBuffer(b1.position)};
    const float2 middle = 0.25 * (onto[0] + onto[1] + onto[2] + onto[3]);
    if (any(abs(middle) > 1e6)) return;
    RibbonPiece piece;
    piece.first = index;
    piece.strand = p.strand;
    piece.origin = int2(floor(middle));
    const float2 origin = float2(piece.origin);
    const float2 pa0 = onto[0] - origin;
    const float2 pa1 = onto[1] - origin;
    const float2 pb0 = onto[2] - origin;
    const float2 pb1 = onto[3] - origin;
    piece.begins = lineThrough(pa1, pa0);
    piece.ends = lineThrough(pb0, pb1);
    piece.left = lineThrough(pa0, pb0);
    piece.right = lineThrough(pb1, pa1);
    piece.depth = float2(a0.position.z / a0.position.w, b0.position.z / b0.position.w);
    piece.coverage = float2(a0.coverage, b0.coverage);
    visitPixels(piece, pa0, pa1, pb0, pb1);
}
