// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles as pixels: a group of threads each, which takes the pixels around it in turns; triangles are cut into slices
// where they are few. In homogeneous coordinates (Olano and Greer 1997), so that what reaches behind the eye needs no
// cutting. What includes this says in visitPixel() what becomes of a pixel that the triangle may touch.
#ifndef HAIRLOOM_TRIANGLE_RASTER_HLSLI
#define HAIRLOOM_TRIANGLE_RASTER_HLSLI
#include "shaders/render/raster.hlsli"

cbuffer Mesh : register(b1) { MeshConstants gMesh; };
StructuredBuffer<float> gPositions : register(t0);  // three a vertex
StructuredBuffer<uint> gIndices : register(t2);

static const float kBeside = -1e-5;  // of the triangle: neighbours leave no gaps

struct Corners {
    float3 edge[3];  // times a place (x, y, 1): a corner's share divided by w
    float3 depths;   // z of the corners in clip space
    int2 origin;     // pixel that places count from
};

float3 vertexOf(StructuredBuffer<float> values, uint vertex) {
    return float3(values[3u * vertex], values[3u * vertex + 1u], values[3u * vertex + 2u]);
}

// Shares of the corners divided by w; their sum is one by w there.
float3 sharesAt(Corners c, float2 at) {
    const float3 p = float3(at, 1);
    return float3(dot(c.edge[0], p), dot(c.edge[1], p), dot(c.edge[2], p));
}

// The same of the corners themselves.
float3 sharesOfFace(Corners c, float2 at) {
    const float3 shares = sharesAt(c, at);
    return shares / (shares.x + shares.y + shares.z);
}

float3 onFace(StructuredBuffer<float> values, uint face, float3 shares) {
    return shares.x * vertexOf(values, gIndices[3u * face]) + shares.y * vertexOf(values, gIndices[3u * face + 1u]) +
           shares.z * vertexOf(values, gIndices[3u * face + 2u]);
}

// Depth, or below 0 outside.
float depthAt(Corners c, float2 at) {
    const float3 shares = sharesAt(c, at);
    const float sum = shares.x + shares.y + shares.z;
    const bool inside = sum > 0.0 && min(shares.x, min(shares.y, shares.z)) >= kBeside * sum;
    return inside ? dot(shares, c.depths) : -1.0;
}

void visitPixel(Corners c, int2 pixel, uint face);

[numthreads(HAIRLOOM_LIST_GROUP, 1, 1)]
void main(uint3 group : SV_GroupID, uint thread : SV_GroupIndex) {
    const uint face = group.x + group.y * gRaster.rowLength;
    if (face >= gRaster.count) return;
    float4 clip[3];
    float2 minimum = 1e9;
    float2 maximum = -1e9;
    bool inFront = true;
    for (uint i = 0; i < 3u; ++i) {
        clip[i] = mul(gMesh.clipFromWorld, float4(vertexOf(gPositions, gIndices[3u * face + i]), 1));
        inFront = inFront && clip[i].w > 1e-6;
        const float2 at = onBuffer(float4(clip[i].xyz, max(clip[i].w, 1e-6)));
        minimum = min(minimum, at);
        maximum = max(maximum, at);
    }
    if (max(clip[0].w, max(clip[1].w, clip[2].w)) <= 0.0) return;
    const float2 low = gRaster.window.xy;
    const float2 high = low + gRaster.window.zw - 1.0;
    const int2 from = int2(inFront ? clamp(floor(minimum - 0.5 - gRaster.sampleReach), low, high + 1.0) : low);
    const int2 to = int2(inFront ? clamp(ceil(maximum - 0.5 + gRaster.sampleReach), low - 1.0, high) : high);
    if (any(to < from)) return;

    Corners c;
    c.origin = (from + to) >> 1;
    float3 v[3];
    for (uint k = 0; k < 3u; ++k) {
        const float2 scaled = 0.5 * (clip[k].ww + float2(clip[k].x, -clip[k].y)) * gRaster.window.zw;
        v[k] = float3(scaled + clip[k].w * (low - float2(c.origin)), clip[k].w);
    }
    const float det = dot(v[0], cross(v[1], v[2]));
    if (abs(det) < 1e-20) return;
    c.edge[0] = cross(v[1], v[2]) / det;
    c.edge[1] = cross(v[2], v[0]) / det;
    c.edge[2] = cross(v[0], v[1]) / det;
    c.depths = float3(clip[0].z, clip[1].z, clip[2].z);
    const uint width = uint(to.x - from.x + 1);
    const uint count = width * uint(to.y - from.y + 1);
    for (uint n = group.z * HAIRLOOM_LIST_GROUP + thread; n < count; n += HAIRLOOM_LIST_GROUP * gRaster.slices) {
        visitPixel(c, from + int2(int(n % width), int(n / width)), face);
    }
}
#endif
