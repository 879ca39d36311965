// SPDX-License-Identifier: GPL-3.0-or-later
// A ribbon turned to the eye: vertex 2k lies on one side of curve point k, 2k + 1 on the other.
#include "shaders/render/curve.hlsli"

struct RibbonCorner {
    float4 position;
    float coverage;  // of the ribbon by the hair
    float depth;     // metres in front of the eye; clip space's, 0...1, where there is no perspective
};

RibbonCorner ribbonCorner(ViewConstants view, CurvePoint p, bool second) {
    const float3 centre_ws = p.position_ws.xyz;
    const float3 toEye = view.eye_ws.xyz - centre_ws * view.eye_ws.w;
    const float3 across = cross(unpackUnit(p.tangentXy), toEye);
    const float3 side = across * rsqrt(max(dot(across, across), 1e-20));
    const float pixelSize = view.pixelSize * (view.eye_ws.w > 0 ? length(toEye) : 1.0);
    const float radius = max(p.position_ws.w, 0.5 * view.minWidth * pixelSize);
    RibbonCorner corner;
    corner.position = mul(view.clipFromWorld, float4(centre_ws + side * (second ? radius : -radius), 1));
    // A hair thinner than the least width keeps its share of light by being as transparent as it is too wide.
    corner.coverage = radius > 0 ? p.opacity * p.position_ws.w / radius : 0;
    corner.depth = view.eye_ws.w > 0 ? corner.position.w : corner.position.z;
    return corner;
}
