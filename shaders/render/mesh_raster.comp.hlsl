// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles into the samples of a frame, as strand_raster.comp.hlsl does hair: a group of threads each, which takes the
// pixels around it in turns; triangles are cut into slices where they are few. In homogeneous coordinates (Olano and
// Greer 1997), so that what reaches behind the eye needs no cutting.
#include "shaders/render/raster.hlsli"
#include "shaders/render/skin.hlsli"

cbuffer Constants : register(b0) { ShadeConstants gShade; };
cbuffer Mesh : register(b1) { MeshConstants gMesh; };
StructuredBuffer<float> gPositions : register(t0);  // three a vertex
StructuredBuffer<float> gNormals : register(t1);
StructuredBuffer<uint> gIndices : register(t2);
StructuredBuffer<float4> gAlbedo : register(t3);  // per triangle
RWStructuredBuffer<uint> gNearest : register(u0);
RWStructuredBuffer<uint> gLight : register(u1);

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

// Depth, or below 0 outside.
float depthAt(Corners c, float2 at) {
    const float3 shares = sharesAt(c, at);
    const float sum = shares.x + shares.y + shares.z;
    const bool inside = sum > 0.0 && min(shares.x, min(shares.y, shares.z)) >= kBeside * sum;
    return inside ? dot(shares, c.depths) : -1.0;
}

float3 lightAt(Corners c, float2 at, uint face) {
    const uint3 v = uint3(gIndices[3u * face], gIndices[3u * face + 1u], gIndices[3u * face + 2u]);
    float3 shares = sharesAt(c, at);
    shares /= shares.x + shares.y + shares.z;
    const float3 position_ws =
        shares.x * vertexOf(gPositions, v.x) + shares.y * vertexOf(gPositions, v.y) + shares.z * vertexOf(gPositions, v.z);
    const float3 normal_ws =
        shares.x * vertexOf(gNormals, v.x) + shares.y * vertexOf(gNormals, v.y) + shares.z * vertexOf(gNormals, v.z);
    return skinLight(gShade, gMesh, position_ws, normal_ws, gAlbedo[face].rgb);
}

void visitPixel(Corners c, int2 pixel, uint face) {
    const float2 middle = float2(pixel - c.origin) + 0.5;
    const uint samples = gRaster.samples;
    const uint base = pixelIndex(pixel) * samples;
    uint shown = 0;
    float2 place = 0;
    for (uint s = 0; s < samples; ++s) {
        const float2 at = middle + samplePlace(s);
        const float depth = depthAt(c, at);
        if (depth < 0.0 || depth > 1.0) continue;
        const uint bits = asuint(depth);
        if (gRaster.phase == HAIRLOOM_PHASE_NEAREST) {
            if (bits < gNearest[base + s]) InterlockedMin(gNearest[base + s], bits);
        } else if (bits == gNearest[base + s]) {
            if (shown == 0u) place = at;
            shown |= 1u << s;
        }
    }
    if (shown == 0u) return;
    // Once a pixel: in its middle, or where that lies beside the triangle at the first sample that shows.
    const uint light = packLight(lightAt(c, depthAt(c, middle) >= 0.0 ? middle : place, face));
    for (uint k = 0; k < samples; ++k) {
        if (((shown >> k) & 1u) != 0u) InterlockedMax(gLight[base + k], light);
    }
}

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
