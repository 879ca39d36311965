// SPDX-License-Identifier: MIT
// Light that other fibres have scattered before (after Zinke et al. 2008); docs/rendering.md says what is different, and
// core/shading/dual_scattering.h is the reference. Who includes it looks up what is asked for here.
#ifndef HAIRLOOM_DUAL_SCATTERING_HLSLI
#define HAIRLOOM_DUAL_SCATTERING_HLSLI
#include "fibre.hlsli"
#include "layer_light.hlsli"

// Cosines of where light comes from and goes to.
struct FibreCosines {
    float cosIn, dSquared;  // of theta_i; of theta_d, squared
    float thetaD;         // 0 ... 1 is 0 ... 90 degrees
};

FibreCosines fibreCosines(FibreFrame f) {
    FibreCosines c;
    c.cosIn = sqrt(saturate(1.0 - f.sinIn * f.sinIn));
    const float cosOut = sqrt(saturate(1.0 - f.sinOut * f.sinOut));
    c.dSquared = max(0.5 * (1.0 + c.cosIn * cosOut + f.sinIn * f.sinOut), 1e-4);
    c.thetaD = acos(sqrt(min(c.dSquared, 1.0))) * (2.0 / 3.14159265);
    return c;
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

// Light that fibres have sent on and that still goes the lamp's way, and how wide and where along the fibre it leaves.
struct OnwardLight {
    float3 light;  // times `share`
    float3 share;
    float met;  // fibres that it has met, mean
    float tilt, variance;
};

// `before` fibres up to the light.
OnwardLight onwardLight(FibreAverages averages, float before, float3 tint) {
    OnwardLight onward;
    onward.share = shareOf(averages.moments, tint);
    const Stopped stopped = stoppedBy(tinted(averages.moments, onward.share));
    onward.light = max(exp(-(stopped.share * before)) - exp(-before), 0.0);
    onward.met = scatteringsOf(before * dot(averages.forward.rgb * onward.share, 1.0 / 3.0));
    onward.tilt = averages.rest.z + onward.met * averages.rest.x;
    onward.variance = averages.rest.w + onward.met * averages.forward.w;
    return onward;
}

// Light among the fibres at a point, and how wide and where along the fibre what goes no lamp's way leaves.
struct MultipleLight {
    OnwardLight onward;
    float3 diffuse;
    float diffuseTilt, diffuseVariance;
};

// `before` fibres up to the light, `all` from side to side; `ground`: albedo of what lies behind them.
MultipleLight multipleLight(FibreAverages averages, float cosPhi, float before, float all, float3 tint, float3 ground) {
    MultipleLight m;
    m.onward = onwardLight(averages, before, tint);
    const FibreMoments moments = tinted(averages.moments, m.onward.share);
    const LayerLight light = lightInLayer(moments, before, all, ground);
    m.diffuse = max(moments.albedo * light.fluence - 2.0 * cosPhi * moments.first * light.flux, 0.0) / 6.2831853;
    m.diffuseTilt = averages.rest.z + (m.onward.met + 1.0) * averages.rest.x + averages.rest.y;
    m.diffuseVariance = averages.rest.w + (m.onward.met + 1.0) * averages.forward.w + averages.backward.w;
    return m;
}

// Radians.
float spreadWidth(float variance, float least, float most) { return clamp(sqrt(variance), least, most); }

// M of a lobe so wide; `factors` is what normalises it.
float spreadLobe(FibreFrame f, float factors, float tilt, float width) {
    const float x = (0.5 * (asin(clamp(f.sinIn, -1.0, 1.0)) + asin(clamp(f.sinOut, -1.0, 1.0))) - tilt) / width;
    return factors * exp(-0.5 * x * x) / (width * 2.5066283);
}
#endif
