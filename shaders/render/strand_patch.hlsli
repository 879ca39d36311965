// SPDX-License-Identifier: GPL-3.0-or-later
// Tessellated ribbons (Rünz 2012, Section 6.2): a patch is a run of up to 32 points of a strand.
#include "shaders/render/ribbon.hlsli"

#define POINTS HAIRLOOM_PATCH_POINTS

struct ControlPoint {
    float4 position_ws : POSITION;  // w: radius
    float4 tangent : TANGENT;       // m of Eq. 56; w: opacity
    nointerpolation uint4 patch : PATCH;  // x: strand, y: curve point of the ribbon's first, z: its segments,
                                          // w: 1 when the first control point only lends its place; << 8: their number
};

struct PatchFactors {
    float edge[4] : SV_TessFactor;
    float inside[2] : SV_InsideTessFactor;
};
