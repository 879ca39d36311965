// SPDX-License-Identifier: GPL-3.0-or-later
// Light that other fibres have scattered before, from tables; core/shading/dual_scattering.h is the reference.
#include "runtime/shaders/dual_scattering.hlsli"
#include "shaders/render/fibre_tables.hlsli"

Texture2D<float4> gProfile : register(t14);        // N of all lobes
Texture2D<float4> gSpreadFactors : register(t16);  // what normalises a wide lobe

#ifdef HAIRLOOM_LOOK
#include "shaders/render/layer_averages.hlsli"

FibreAverages averagesAt(float thetaD, float3 absorption) {
    return averagesOf(layerAverages(thetaD, absorption.x), layerAverages(thetaD, absorption.y),
                      layerAverages(thetaD, absorption.z));
}

float3 profileAt(float2 at, float3 absorption) {
    float3 n = 0;
    [unroll] for (uint c = 0; c < 3u; ++c) n[c] = lookUpLayers(gProfile, at, absorption[c]).r;
    return n;
}
#else
Texture2D<float4> gAverages : register(t15);  // shares of light sent on and back, tilts and variances

FibreAverages averagesAt(float thetaD, float3 absorption) {
    FibreAverages a;
    a.forward = lookUp(gAverages, float2(thetaD, 0.0));
    a.backward = lookUp(gAverages, float2(thetaD, 0.25));
    a.rest = lookUp(gAverages, float2(thetaD, 0.5));
    a.moments.albedo = a.forward.rgb + a.backward.rgb;
    a.moments.first = lookUp(gAverages, float2(thetaD, 0.75)).rgb;
    a.moments.second = lookUp(gAverages, float2(thetaD, 1.0)).rgb;
    return a;
}

float3 profileAt(float2 at, float3 absorption) { return lookUp(gProfile, at).rgb; }
#endif

float spreadLongitudinal(FibreConstants fibre, FibreFrame f, float tilt, float variance) {
    const float width = spreadWidth(variance, fibre.minSpread, fibre.maxSpread);
    const float v = (width - fibre.minSpread) / (fibre.maxSpread - fibre.minSpread);
    const float factors =
        lookUp(gSpreadFactors, float2(abs(f.sinIn), v)).r * lookUp(gSpreadFactors, float2(abs(f.sinOut), v)).r;
    return spreadLobe(f, factors, tilt, width);
}

// As S cos theta_i, but for cos theta_i / cos^2 theta_d.
float3 onwardFrom(FibreConstants fibre, FibreFrame f, FibreCosines c, OnwardLight onward, float3 absorption) {
    const float m = spreadLongitudinal(fibre, f, onward.tilt, onward.variance);
    return m * onward.light * (onward.share * profileAt(float2(0.5 + 0.5 * f.cosPhi, c.thetaD), absorption));
}

// Times the irradiance: as S cos theta_i. `before` fibres up to the light, `all` from side to side; `ground`: albedo of
// what lies behind them.
float3 multipleScattering(FibreConstants fibre, FibreFrame f, float before, float all, float3 tint,
                          float3 absorption, float3 ground) {
    const FibreCosines c = fibreCosines(f);
    const MultipleLight m = multipleLight(averagesAt(c.thetaD, absorption), f.cosPhi, before, all, tint, ground);
    const float diffuseM = spreadLongitudinal(fibre, f, m.diffuseTilt, m.diffuseVariance);
    return (onwardFrom(fibre, f, c, m.onward, absorption) + diffuseM * m.diffuse) * (c.cosIn / c.dSquared);
}

// Likewise, where a grid has the rest: fibres before have let `passed` of the light by without meeting it.
float3 onwardScattering(FibreConstants fibre, FibreFrame f, float passed, float3 tint, float3 absorption) {
    const FibreCosines c = fibreCosines(f);
    const OnwardLight onward = onwardLight(averagesAt(c.thetaD, absorption), -log(clamp(passed, 1e-9, 1.0)), tint);
    return onwardFrom(fibre, f, c, onward, absorption) * (c.cosIn / c.dSquared);
}
