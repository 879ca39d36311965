// SPDX-License-Identifier: MIT
// Hair in the light of one lamp.
#include "kajiya.hlsli"
#include "ribbons.hlsli"

float4 main(Ribbon hair) : SV_Target {
    if (isLeftOut(hair)) discard;
    const float3 tangent = normalize(hair.tangent), toEye = normalize(hair.toEye);
    const float3 toLight = gView.toLight.xyz;
    const float3 diffuse = hair.colour * (gView.light.w + (1.0 - gView.light.w) * kajiyaDiffuse(tangent, toLight));
    const float3 shine = gView.specular.rgb * kajiyaSpecular(tangent, toLight, toEye, gView.toLight.w);
    return float4((diffuse + shine) * gView.light.rgb, 1);
}
