// SPDX-License-Identifier: MIT
#include "ribbon_types.h"

cbuffer View : register(b0) { RibbonView gView; };

struct Ribbon {
    float4 position : SV_Position;
    float3 colour : COLOR;
    float3 tangent : TANGENT;
    float3 toEye : EYE;
    float coverage : COVERAGE;  // of the ribbon by the hair
    nointerpolation uint seed : SEED;
};

float chance(uint x, uint y, uint seed) {
    uint h = x * 0x9e3779b1u ^ y * 0x85ebca77u ^ seed * 0xc2b2ae3du;
    h = (h ^ (h >> 15u)) * 0x2c1b3c6du;
    h = (h ^ (h >> 12u)) * 0x297a2d39u;
    return float((h ^ (h >> 15u)) >> 8u) * (1.0 / 16777216.0);
}

// What a thin hair lets through is left to chance, pixel by pixel, so that depth alone sorts hairs; more samples a pixel or frames
// make it smooth.
bool isLeftOut(Ribbon hair) { return hair.coverage < chance(uint(hair.position.x), uint(hair.position.y), hair.seed); }
