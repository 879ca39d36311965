// SPDX-License-Identifier: MIT
// The strip of ribbons.vert with the light that its points have.
#include "ribbon_strip.hlsli"

StructuredBuffer<float4> gColours : register(t2);

Ribbon main(uint vertex : SV_VertexID, uint hair : SV_InstanceID) {
    Ribbon o = ribbonAt(vertex, hair);
    o.colour = gColours[hair * gView.points + (vertex >> 1u)].rgb;
    return o;
}
