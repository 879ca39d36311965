// SPDX-License-Identifier: MIT
// A triangle strip of two vertices a point, turned to the eye, and an instance a hair.
#include "ribbons.hlsli"

StructuredBuffer<float4> gHairs : register(t0);
StructuredBuffer<RibbonLook> gLooks : register(t1);

Ribbon ribbonAt(uint vertex, uint hair) {
    const uint p = vertex >> 1u, last = gView.points - 1u, first = hair * gView.points;
    const float3 here = gHairs[first + p].xyz;
    const float3 along = gHairs[first + min(p + 1u, last)].xyz - gHairs[first + max(p, 1u) - 1u].xyz;
    const float3 toEye = gView.eye.xyz - here;
    const float3 across = cross(along, toEye);
    const float3 side = across * rsqrt(max(dot(across, across), 1e-30));
    const RibbonLook look = gLooks[hair];
    const float wider = gView.specular.w > 0.0 ? gView.specular.w : 1.0;
    const float wanted = wider * lerp(look.radii.x, look.radii.y, float(p) / float(last));
    const float radius = max(wanted, 0.5 * gView.minPixels * gView.pixelSize * length(toEye));
    Ribbon o;
    o.position = mul(gView.clipFromWorld, float4(here + side * ((vertex & 1u) != 0u ? radius : -radius), 1));
    o.colour = look.colour.rgb;
    o.tangent = along * rsqrt(max(dot(along, along), 1e-30));
    o.toEye = toEye;
    o.coverage = radius > 0.0 ? wanted / radius : 0.0;
    o.seed = hair;
    return o;
}
