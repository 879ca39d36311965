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
