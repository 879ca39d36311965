// SPDX-License-Identifier: GPL-3.0-or-later
// Light that other fibres have scattered before; core/shading/dual_scattering.h says how and is the reference.
#include "shaders/fibre_tables.hlsli"

Texture2D<float4> gSpread : register(t14);         // N averaged over light from half of the directions
Texture2D<float4> gSpreadFactors : register(t16);  // what normalises a wide lobe

// A fibre's shares of light sent on and back with their variances, and its tilts.
struct FibreAverages {
    float4 forward, backward;
    float4 rest;  // tilt of light sent on, sent back and of all; variance of all
};
#ifdef HAIRLOOM_LOOK
#include "shaders/layer_averages.hlsli"

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
    }
    const float2 shares = max(float2(dot(a.forward.rgb, 1.0), dot(a.backward.rgb, 1.0)), 1e-6);
    a.forward.w = variance.x / shares.x;
    a.backward.w = variance.y / shares.y;
    const float all = shares.x + shares.y;
    a.rest = float4(tilt / shares, (tilt.x + tilt.y) / all, (variance.x + variance.y) / all);
    return a;
}

float3 spreadAt(float2 at, float3 absorption) {
    float3 n = 0;
    [unroll] for (uint c = 0; c < 3u; ++c) n[c] = lookUpLayers(gSpread, at, absorption[c]).r;
    return n;
}
#else
Texture2D<float4> gAverages : register(t15);  // shares of light sent on and back, tilts and variances

FibreAverages averagesAt(float thetaD, float3 absorption) {
    FibreAverages a;
    a.forward = lookUp(gAverages, float2(thetaD, 0.0));
    a.backward = lookUp(gAverages, float2(thetaD, 0.5));
    a.rest = lookUp(gAverages, float2(thetaD, 1.0));
    return a;
}

float3 spreadAt(float2 at, float3 absorption) { return lookUp(gSpread, at).rgb; }
#endif

float spreadLongitudinal(FibreConstants fibre, FibreFrame f, float tilt, float variance) {
    const float width = clamp(sqrt(variance), fibre.spread.x, fibre.spread.y);
    const float v = (width - fibre.spread.x) / (fibre.spread.y - fibre.spread.x);
    const float factors =
        lookUp(gSpreadFactors, float2(abs(f.sinIn), v)).r * lookUp(gSpreadFactors, float2(abs(f.sinOut), v)).r;
    const float x = (0.5 * (asin(clamp(f.sinIn, -1.0, 1.0)) + asin(clamp(f.sinOut, -1.0, 1.0))) - tilt) / width;
    return factors * exp(-0.5 * x * x) / (width * 2.5066283);
}

float scatteringsOf(float x) { return x < 1e-2 ? 1.0 + 0.5 * x : x / (1.0 - exp(-x)); }

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
    // A tint may be above 1; no fibre gives more light than it gets.
    const float3 share = min(tint, 0.99 / max(forward.rgb + backward.rgb, 1e-4));
    const float3 lost = 1.0 - forward.rgb * share;
    const float3 turned = backward.rgb * share;

    const float3 rate = sqrt(max(lost * lost - turned * turned, 1e-6));
    const float3 returned = turned / (lost + rate);
    const float3 falling = exp(-rate * before);
    const float3 back = falling * exp(-2.0 * rate * max(all - before, 0.0));
    const float3 turns = 1.0 - returned * returned * exp(-2.0 * rate * max(all, before));
    const float3 down = max((falling - returned * returned * back) / turns - exp(-before), 0.0);
    const float3 up = returned * (falling - back) / turns;

    // What comes back from the ground goes up and down again.
    const float3 deep = exp(-rate * max(all, before));
    const float3 reached = (1.0 - returned * returned) * deep / turns;
    const float3 kept = returned * (1.0 - deep * deep) / turns;
    const float3 sent = ground * reached / (1.0 - ground * kept);
    const float3 rising = exp(-rate * max(all - before, 0.0));
    const float3 turning = deep * falling;
    const float3 groundUp = sent * (rising - returned * returned * turning) / turns;
    const float3 groundDown = sent * returned * (rising - turning) / turns;
    // It remembers nothing of the light's direction: 2 / pi N towards all; and meets pi / 2 times the fibres.
    const float evenM = cosDSquared;

    const float passed = scatteringsOf(before * dot(forward.rgb * share, 1.0 / 3.0));
    const float downM = spreadLongitudinal(fibre, f, rest.z + passed * rest.x, rest.w + passed * forward.w);
    const float upM = spreadLongitudinal(fibre, f, rest.z + (passed + 1.0) * rest.x + rest.y,
                                         rest.w + (passed + 1.0) * forward.w + backward.w);
    const float3 downN = spreadAt(float2(0.5 + 0.5 * f.cosPhi, thetaD), absorption);
    const float3 upN = spreadAt(float2(0.5 - 0.5 * f.cosPhi, thetaD), absorption);
    return share * ((downM * down + evenM * groundDown) * downN + (upM * up + evenM * groundUp) * upN) *
           (cosIn / cosDSquared);
}
