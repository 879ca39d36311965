// SPDX-License-Identifier: GPL-3.0-or-later
// How finely a patch is cut: so that no chord lies farther from the curve than a part of a pixel. Nothing of what is out of sight.
#include "shaders/render/strand_patch.hlsli"

float2 onScreen(float3 position_ws, inout bool behind) {
    const float4 clip = mul(gView.clipFromWorld, float4(position_ws, 1));
    behind = behind || clip.w <= 0;
    return clip.xy / max(clip.w, 1e-6);
}

// In pixels; beyond the ends the curve goes on as a mirror image.
struct Window {
    float2 before, here, next, after;
};

// Of the curve between `here` and `next` (Eq. 55), at its ends, where it is greatest.
float secondDerivative(Window w) {
    const float2 way = 6.0 * (w.next - w.here);
    const float2 tangentHere = 0.5 * (w.next - w.before);
    const float2 tangentNext = 0.5 * (w.after - w.here);
    return max(length(way - 4.0 * tangentHere - 2.0 * tangentNext), length(2.0 * tangentHere + 4.0 * tangentNext - way));
}

PatchFactors factors(InputPatch<ControlPoint, 1> points) {
    const ControlPoint c = points[0];
    const uint first = c.patch.z;
    const uint segments = c.patch.w;
    const float2 pixels = 0.5 * float2(gPatch.width, gPatch.height);
    bool behind = false;
    Window w;
    w.here = onScreen(givenPoint(c, first).position_ws.xyz, behind) * pixels;
    w.next = onScreen(givenPoint(c, first + 1u).position_ws.xyz, behind) * pixels;
    w.before = 2.0 * w.here - w.next;
    if (first > 0u) w.before = onScreen(givenPoint(c, first - 1u).position_ws.xyz, behind) * pixels;
    float2 minimum = min(w.here, w.next);
    float2 maximum = max(w.here, w.next);
    float bend = 0;
    for (uint k = 0; k < segments; ++k) {
        w.after = 2.0 * w.next - w.here;
        const uint beyond = first + k + 2u;
        if (beyond < c.points) w.after = onScreen(givenPoint(c, beyond).position_ws.xyz, behind) * pixels;
        bend = max(bend, secondDerivative(w));
        minimum = min(minimum, w.next);
        maximum = max(maximum, w.next);
        w.before = w.here;
        w.here = w.next;
        w.next = w.after;
    }
    // A curve's arc lies an eighth of its second derivative from its chord, and n pieces of it n² times less. A whole number of
    // pieces a segment, so that the curve's points stay corners.
    const float pieces = clamp(ceil(sqrt(bend / (8.0 * gPatch.deviation))), 1.0, floor(64.0 / float(segments)));
    const bool seen = behind || (all(maximum > -1.1 * pixels) && all(minimum < 1.1 * pixels));
    PatchFactors o;
    const float along = seen ? float(segments) * pieces : 0.0;
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
[outputcontrolpoints(1)]
[patchconstantfunc("factors")]
[maxtessfactor(64.0)]
ControlPoint main(InputPatch<ControlPoint, 1> points, uint i : SV_OutputControlPointID) {
    return points[i];
}
