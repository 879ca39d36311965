// SPDX-License-Identifier: MIT
// Colour or absorption of hair from place to place: gradients along it, streaks, dye, white strands and chance.
// core/shading/strand_look.h is the reference.
#ifndef HAIRLOOM_HAIR_LOOK_HLSLI
#define HAIRLOOM_HAIR_LOOK_HLSLI
#include "look_types.h"

struct StrandPlace {
    float along;   // 0 root ... 1 tip
    float random;  // 0 ... 1
    float streak;
    float dye;
    float pigment;  // times that of the look; 0 is white
    float length;   // metres, the strand's
    float4 own;  // the strand's own colour; w: 1 where it has one
};

float gradientOf(LookConstants look, float along) { return saturate((along - look.gradientStart) * look.gradientScale); }

// Of a strand with so much of the pigment.
float3 pigmented(LookConstants look, float3 natural, float pigment) {
    if (look.absorbs > 0) return pigment * natural;
    return pigment == 1.0 ? natural : pow(max(natural, 1e-6), sqrt(pigment));
}

// Linear RGB, or absorption a fibre radius.
float3 lookOf(LookConstants look, StrandPlace p) {
    const bool absorbs = look.absorbs > 0;
    const float t = gradientOf(look, p.along);
    float3 own = p.own.rgb;
    if (absorbs) {
        const float3 depth = look.ownScale * log(clamp(own, 0.001, 1.0));
        own = depth * depth;
    }
    const float3 plain = p.own.w > 0.0 ? own : lerp(look.root.rgb, look.tip.rgb, t);
    const float3 streak = pigmented(look, lerp(look.streakRoot.rgb, look.streakTip.rgb, t),
                                    1.0 + look.streakPigment * (p.pigment - 1.0));
    const float3 streaked = lerp(pigmented(look, plain, p.pigment), streak, p.streak);
    const float grown = saturate((p.along * p.length - look.regrowthStart) * look.regrowthScale);
    const float dye = p.dye * saturate((p.along - look.dyeStart) * look.dyeScale) * (grown * grown * (3.0 - 2.0 * grown));
    const float3 dyed = lerp(streaked, look.dye.rgb, dye);
    const float factor = 1.0 + look.spread * (2.0 * p.random - 1.0);
    // Chiang et al. 2016: the logarithm of a colour goes with the root of the absorption.
    return absorbs ? factor * dyed : pow(max(dyed, 1e-6), sqrt(factor));
}

// Radiance that strands give off.
float3 emissionOf(LookConstants look, float along) {
    return lerp(look.emissionRoot.rgb, look.emissionTip.rgb, gradientOf(look, along));
}
#endif
