// SPDX-License-Identifier: GPL-3.0-or-later
// Light that other fibres have scattered before; core/shading/dual_scattering.h says how and is the reference.
#include "shaders/render/fibre_tables.hlsli"
#include "shaders/render/layer_light.hlsli"

Texture2D<float4> gProfile : register(t14);        // N of all lobes
Texture2D<float4> gSpreadFactors : register(t16);  // what normalises a wide lobe

// A fibre's shares of light sent on and back with their variances, and its tilts.
struct FibreAverages {
    float4 forward, backward;
    float4 rest;  // tilt of light sent on, sent back and of all; variance of all
    FibreMoments moments;
};
#ifdef HAIRLOOM_LOOK
#include "shaders/render/layer_averages.hlsli"

FibreAverages averagesAt(float thetaD, float3 absorption) {
    FibreAverages a;
    a.forward = 0;
    a.backward = 0;
    float2 variance = 0;
    float2 tilt = 0;
    [unroll] for (uint c = 0; c < 3u; ++c) {
        const LayerAverages one = layerAverages(thetaD, absorption[c]);
        a.forward[c] = one.shares.x;
        a.backward[c] = one.shares.y;
        variance += one.shares.zw;
        tilt += one.tilts.xy;
        a.moments.albedo[c] = one.shares.x + one.shares.y;
        a.moments.first[c] = one.moments.x;
        a.moments.second[c] = one.moments.y;
    }
    const float2 shares = max(float2(dot(a.forward.rgb, 1.0), dot(a.backward.rgb, 1.0)), 1e-6);
    a.forward.w = variance.x / shares.x;
    a.backward.w = variance.y / shares.y;
    const float all = shares.x + shares.y;
    a.rest = float4(tilt / shares, (tilt.x + tilt.y) / all, (variance.x + variance.y) / all);
    return a;
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
    const float width = clamp(sqrt(variance), fibre.minSpread, fibre.maxSpread);
    const float v = (width - fibre.minSpread) / (fibre.maxSpread - fibre.minSpread);
    const float factors =
        lookUp(gSpreadFactors, float2(abs(f.sinIn), v)).r * lookUp(gSpreadFactors, float2(abs(f.sinOut), v)).r;
    const float x = (0.5 * (asin(clamp(f.sinIn, -1.0, 1.0)) + asin(clamp(f.sinOut, -1.0, 1.0))) - tilt) / width;
    return factors * exp(-0.5 * x * x) / (width * 2.5066283);
}

float scatteringsOf(float x) { return x < 1e-2 ? 1.0 + 0.5 * x : x / (1.0 - exp(-x)); }

// A tint may be above 1; no fibre gives more light than it gets.
float3 shareOf(FibreMoments m, float3 tint) { return min(tint, 0.995 / max(m.albedo, 1e-4)); }

FibreMoments tinted(FibreMoments m, float3 share) {
    FibreMoments result;
    result.albedo = m.albedo * share;
    result.first = m.first * share;
    result.second = m.second * share;
    return result;
}

// Times the irradiance: as S cos theta_i. `before` fibres up to the light, `all` from side to side; `ground`: albedo of
// what lies behind them.
float3 multipleScattering(FibreConstants fibre, FibreFrame f, float before, float all, float3 tint,
                          float3 absorption, float3 ground) {
    const float cosIn = sqrt(saturate(1.0 - f.sinIn * f.sinIn));
    const float cosOut = sqrt(saturate(1.0 - f.sinOut * f.sinOut));
    const float cosDSquared = max(0.5 * (1.0 + cosIn * cosOut + f.sinIn * f.sinOut), 1e-4);
    const float thetaD = acos(sqrt(min(cosDSquared, 1.0))) * (2.0 / 3.14159265);
    const FibreAverages averages = averagesAt(thetaD, absorption);
    const float4 forward = averages.forward;
    const float4 backward = averages.backward;
    const float4 rest = averages.rest;
    const float3 share = shareOf(averages.moments, tint);
    const FibreMoments moments = tinted(averages.moments, share);
    const LayerLight light = lightInLayer(moments, before, all, ground);
    const float3 onward = max(light.onward - exp(-before), 0.0);
    const float3 diffuse =
        max(moments.albedo * light.fluence - 2.0 * f.cosPhi * moments.first * light.flux, 0.0) / 6.2831853;

    const float passed = scatteringsOf(before * dot(forward.rgb * share, 1.0 / 3.0));
    const float onwardM = spreadLongitudinal(fibre, f, rest.z + passed * rest.x, rest.w + passed * forward.w);
    const float diffuseM = spreadLongitudinal(fibre, f, rest.z + (passed + 1.0) * rest.x + rest.y,
                                              rest.w + (passed + 1.0) * forward.w + backward.w);
    const float3 n = share * profileAt(float2(0.5 + 0.5 * f.cosPhi, thetaD), absorption);
    return (onwardM * onward * n + diffuseM * diffuse) * (cosIn / cosDSquared);
}
