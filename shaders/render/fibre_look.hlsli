// SPDX-License-Identifier: GPL-3.0-or-later
// How a place of a strand of light in fibres absorbs, with HAIRLOOM_LOOK from place to place.
#ifndef HAIRLOOM_FIBRE_LOOK_HLSLI
#define HAIRLOOM_FIBRE_LOOK_HLSLI
#include "shaders/render/curve.hlsli"
#ifdef HAIRLOOM_LOOK
#include "shaders/render/point_dye.hlsli"
#endif

struct FibreLook {
    float3 tint;        // times what the tables have
    float3 absorption;  // 0 where they are of the material's own
};

FibreLook fibreLookAt(ShadeConstants shade, StrandHeader strand, float along) {
    const float vary = 1.0 + shade.brightnessVariation * (strand.random * 2.0 - 1.0);
    FibreLook look;
#ifdef HAIRLOOM_LOOK
    look.absorption = lookAt(placeOf(strand, along));
    const float3 white = exp(sqrt(look.absorption) / gLook.ownScale);  // times the colour that much such hair has
    look.tint = shade.bounded != 0 ? min(vary, min(white.x, min(white.y, white.z))) : vary;
#else
    // A strand's own colour is known against the material's, whose absorption the tables hold.
    const float3 own = strand.albedo.w > 0 ? strand.albedo.rgb / max(shade.albedo.rgb, 1e-3) : 1.0;
    look.tint = min(own * (lerp(shade.rootBrightness, shade.tipBrightness, along) * vary), shade.brightestTint);
    look.absorption = 0;
#endif
    return look;
}
#endif
