// SPDX-License-Identifier: GPL-3.0-or-later
// Tangents of the control points, and how finely the patch is cut: by the length of its segments in pixels.
#include "shaders/render/strand_patch.hlsli"

cbuffer Constants : register(b0) { ViewConstants gView; };
cbuffer Patches : register(b2) { PatchConstants gPatch; };

float2 onScreen(float3 position_ws, out float w) {
    const float4 clip = mul(gView.clipFromWorld, float4(position_ws, 1));
    w = clip.w;
    return clip.xy / max(clip.w, 1e-6);
}

PatchFactors factors(InputPatch<ControlPoint, POINTS> points) {
    const uint segments = points[0].patch.z;
    const uint first = points[0].patch.w & 1u;
    float pixels = 0;
    float2 minimum = 1e9;
    float2 maximum = -1e9;
    float w;
    float2 before = onScreen(points[first].position_ws.xyz, w);
    bool behind = w <= 0;
    for (uint i = 0; i <= segments; ++i) {
        const float2 here = onScreen(points[first + i].position_ws.xyz, w);
        behind = behind || w <= 0;
        pixels += length((here - before) * 0.5 * float2(gPatch.width, gPatch.height));
        minimum = min(minimum, here);
        maximum = max(maximum, here);
        before = here;
    }
    // A whole number of pieces a segment, so that the curve's points stay corners.
    const float pieces = clamp(ceil(pixels / (float(segments) * gPatch.pieceLength)), 1.0, floor(64.0 / float(segments)));
    const bool seen = behind || (all(maximum > -1.1) && all(minimum < 1.1));
    PatchFactors o;
    const float along = seen ? float(segments) * max(pieces, 1.0) : 0.0;
    const float across = seen ? 1.0 : 0.0;
    o.edge[0] = across;
    o.edge[1] = along;
    o.edge[2] = across;
    o.edge[3] = along;
    o.inside[0] = along;
    o.inside[1] = across;
    return o;
}

[domain("quad")]
[partitioning("integer")]
[outputtopology("triangle_cw")]
[outputcontrolpoints(POINTS)]
[patchconstantfunc("factors")]
[maxtessfactor(64.0)]
ControlPoint main(InputPatch<ControlPoint, POINTS> points, uint i : SV_OutputControlPointID) {
    ControlPoint o = points[i];
    const uint last = (points[0].patch.w >> 8u) - 1u;
    const uint k = min(i, last);
    // Beyond the ends the curve goes on as a mirror image.
    const float3 here = points[k].position_ws.xyz;
    const float3 before = k > 0u ? points[k - 1u].position_ws.xyz : 2 * here - points[1].position_ws.xyz;
    const float3 after = k < last ? points[k + 1u].position_ws.xyz : 2 * here - points[k - 1u].position_ws.xyz;
    o.tangent.xyz = 0.5 * (after - before);
    return o;
}
