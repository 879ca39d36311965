// SPDX-License-Identifier: MIT
// Hair in the light of one lamp. What a thin hair lets through is left to chance, pixel by pixel, so that depth alone
// sorts hairs; more samples a pixel or frames make it smooth.
#include "kajiya.hlsli"
#include "ribbons.hlsli"

float chance(uint x, uint y, uint seed) {
    uint h = x * 0x9e3779b1u ^ y * 0x85ebca77u ^ seed * 0xc2b2ae3du;
    h = (h ^ (h >> 15u)) * 0x2c1b3c6du;
    h = (h ^ (h >> 12u)) * 0x297a2d39u;
    return float((h ^ (h >> 15u)) >> 8u) * (1.0 / 16777216.0);
}

float4 main(Ribbon hair) : SV_Target {
    if (hair.coverage < chance(uint(hair.position.x), uint(hair.position.y), hair.seed)) discard;
    const float3 tangent = normalize(hair.tangent), toEye = normalize(hair.toEye);
    const float3 toLight = gView.toLight.xyz;
    const float3 diffuse = hair.colour * (gView.light.w + (1.0 - gView.light.w) * kajiyaDiffuse(tangent, toLight));
    const float3 shine = gView.specular.rgb * kajiyaSpecular(tangent, toLight, toEye, gView.toLight.w);
    return float4((diffuse + shine) * gView.light.rgb, 1);
}
