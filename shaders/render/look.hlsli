// SPDX-License-Identifier: GPL-3.0-or-later
// Colour or absorption from place to place; core/shading/strand_look.h is its reference.
#ifndef HAIRLOOM_LOOK_HLSLI
#define HAIRLOOM_LOOK_HLSLI
#include "shaders/render/curve.hlsli"

cbuffer Look : register(b2) { LookConstants gLook; };

struct StrandPlace {
    float along;   // 0 root ... 1 tip
    float random;  // 0 ... 1
    float streak;
    float dye;
    float pigment;  // times that of the look; 0 is white
    float length;   // metres, the strand's
    float4 own;  // the strand's own colour; w: 1 where it has one
};

float gradientAt(float along) { return saturate((along - gLook.gradientStart) * gLook.gradientScale); }

// Of a strand with so much of the pigment.
float3 pigmented(float3 natural, float pigment) {
    if (gLook.absorbs > 0) return pigment * natural;
    return pigment == 1.0 ? natural : pow(max(natural, 1e-6), sqrt(pigment));
}

// Linear RGB, or absorption a fibre radius.
float3 lookAt(StrandPlace p) {
    const bool absorbs = gLook.absorbs > 0;
    const float t = gradientAt(p.along);
    float3 own = p.own.rgb;
    if (absorbs) {
        const float3 depth = gLook.ownScale * log(clamp(own, 0.001, 1.0));
        own = depth * depth;
    }
    const float3 plain = p.own.w > 0.0 ? own : lerp(gLook.root.rgb, gLook.tip.rgb, t);
    const float3 streak = pigmented(lerp(gLook.streakRoot.rgb, gLook.streakTip.rgb, t),
                                    1.0 + gLook.streakPigment * (p.pigment - 1.0));
    const float3 streaked = lerp(pigmented(plain, p.pigment), streak, p.streak);
    const float grown = saturate((p.along * p.length - gLook.regrowthStart) * gLook.regrowthScale);
    const float dye = p.dye * saturate((p.along - gLook.dyeStart) * gLook.dyeScale) * (grown * grown * (3.0 - 2.0 * grown));
    const float3 dyed = lerp(streaked, gLook.dye.rgb, dye);
    const float factor = 1.0 + gLook.spread * (2.0 * p.random - 1.0);
    // Chiang et al. 2016: the logarithm of a colour goes with the root of the absorption.
    return absorbs ? factor * dyed : pow(max(dyed, 1e-6), sqrt(factor));
}

// Radiance that strands give off.
float3 emissionAt(float along) { return lerp(gLook.emissionRoot.rgb, gLook.emissionTip.rgb, gradientAt(along)); }
#endif
