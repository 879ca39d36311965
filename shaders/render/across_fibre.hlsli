// SPDX-License-Identifier: GPL-3.0-or-later
// Marschner's paths across a fibre's width (Zinke and Weber 2007): a ray that meets the section at an offset leaves it in one
// direction, which roughness widens; how much goes each way follows from the same optics that the tables are baked from
// (core/shading/azimuthal.h). Each path's mean over the width is 1, so that tables keep the light, and this places it.
#ifndef HAIRLOOM_ACROSS_FIBRE_HLSLI
#define HAIRLOOM_ACROSS_FIBRE_HLSLI
#include "shaders/shared/render_types.h"

static const uint kRaysOfCell = 4u;
static const float kTurn = 6.28318531;

struct AcrossWeights {
    float reflected[HAIRLOOM_ACROSS_CELLS];  // of R, TT and TRT, cell after cell from side to side
    float3 through[HAIRLOOM_ACROSS_CELLS];
    float3 returned[HAIRLOOM_ACROSS_CELLS];
};

// The wrapped Gaussian's two nearest turns, not normalised.
float spreadAround(float angle, float deviation) {
    const float x = abs(angle - kTurn * round(angle / kTurn)) / deviation;
    const float beyond = kTurn / deviation - x;
    return exp(-0.5 * x * x) + exp(-0.5 * beyond * beyond);
}

// Of unpolarised light at a border of these indices (Marschner et al. 2003, appendix B); cosines outside and inside.
float fresnelAcross(float perpendicular, float parallel, float outside, float inside) {
    const float s = (outside - perpendicular * inside) / (outside + perpendicular * inside);
    const float p = (parallel * outside - inside) / (parallel * outside + inside);
    return min(0.5 * (s * s + p * p), 1.0);
}

// `phi`: azimuth of the light against the view, around the tangent. `sinThetaD`: half the angle between their inclinations.
AcrossWeights acrossWeights(float ior, float deviation, float3 absorption, float phi, float sinThetaD) {
    const float sinSquared = sinThetaD * sinThetaD;
    const float cosD = sqrt(max(1.0 - sinSquared, 1e-6));
    const float flat = sqrt(max(ior * ior - sinSquared, 1e-6));
    const float perpendicular = flat / cosD;
    const float parallel = ior * ior * cosD / flat;
    const float cosInside = sqrt(max(1.0 - sinSquared / (ior * ior), 1e-6));
    AcrossWeights w;
    float reflectedSum = 0;
    float3 throughSum = 0;
    float3 returnedSum = 0;
    for (uint cell = 0; cell < HAIRLOOM_ACROSS_CELLS; ++cell) {
        float reflected = 0;
        float3 through = 0;
        float3 returned = 0;
        for (uint ray = 0; ray < kRaysOfCell; ++ray) {
            const float offset =
                (2.0 / float(HAIRLOOM_ACROSS_CELLS)) * (float(cell) + (float(ray) + 0.5) / float(kRaysOfCell)) - 1.0;
            const float inside = offset / perpendicular;
            const float cosIn = sqrt(max(1.0 - offset * offset, 0.0));
            const float cosTurned = sqrt(max(1.0 - inside * inside, 0.0));
            const float gammaIn = asin(offset);
            const float gammaTurned = asin(inside);
            const float f = fresnelAcross(perpendicular, parallel, cosIn, cosTurned);
            const float3 passed = exp(-absorption * (2.0 * cosTurned / cosInside));
            const float enters = (1.0 - f) * (1.0 - f);
            reflected += f * spreadAround(phi - 2.0 * gammaIn, deviation);
            through += enters * passed * spreadAround(phi - 0.5 * kTurn + 2.0 * (gammaTurned - gammaIn), deviation);
            returned += enters * f * passed * passed * spreadAround(phi + 4.0 * gammaTurned - 2.0 * gammaIn, deviation);
        }
        w.reflected[cell] = reflected;
        w.through[cell] = through;
        w.returned[cell] = returned;
        reflectedSum += reflected;
        throughSum += through;
        returnedSum += returned;
    }
    // Where a path sends next to nothing, its light stays even.
    const float least = 1e-6;
    const float cells = float(HAIRLOOM_ACROSS_CELLS);
    for (uint c = 0; c < HAIRLOOM_ACROSS_CELLS; ++c) {
        w.reflected[c] = (w.reflected[c] * cells + least) / (reflectedSum + least);
        w.through[c] = (w.through[c] * cells + least) / (throughSum + least);
        w.returned[c] = (w.returned[c] * cells + least) / (returnedSum + least);
    }
    return w;
}
#endif
