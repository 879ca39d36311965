// SPDX-License-Identifier: GPL-3.0-or-later
// Writes back fields of the shared structs, so that a test sees where the shader finds them.
#include "shaders/shared/render_types.h"

cbuffer Constants : register(b0) { ShadeConstants gShade; };
StructuredBuffer<StrandHeader> gStrands : register(t0);
StructuredBuffer<CurvePoint> gCurve : register(t1);
RWStructuredBuffer<float4> gResults : register(u0);

[numthreads(1, 1, 1)]
void main() {
    gResults[0] = gShade.eye_ws;
    gResults[1] = float4(gShade.primaryExponent, gShade.diffuse, gShade.brightnessVariation, gShade.clumping);
    gResults[2] = asfloat(uint4(gShade.count, gShade.lightCount, gShade.rowThreads, gShade.subdivisions));
    gResults[3] = gShade.lights[1].irradiance;
    gResults[4] = float4(gShade.lights[2].depthRange, gShade.lights[2].shadows, gShade.lights[2].nearPlane,
                         gShade.lights[2].hairBegins);
    gResults[5] = mul(gShade.lights[1].clipFromWorld, float4(0, 0, 0, 1));
    gResults[6] = gStrands[1].albedo;
    gResults[7] = float4(gStrands[1].random, asfloat(gStrands[1].segmentsBefore), gCurve[1].along, asfloat(gCurve[1].strand));
    gResults[8] = float4(gStrands[1].streak, gStrands[1].dye, gCurve[1].opacity, gStrands[1].length);
}
