// SPDX-License-Identifier: GPL-3.0-or-later
// Marschner et al. 2003 from tables (Rünz 2012, section 6.6.2); core/shading/marschner.h is its reference. With
// HAIRLOOM_LOOK absorption changes from place to place.
#include "shaders/render/fibre_tables.hlsli"

// S cos theta_i of R, TT and TRT. `tint` is taken once by light that crosses the fibre, twice by TRT.
struct FibreLobes {
    float3 reflected, through, returned;
};

#ifdef HAIRLOOM_LOOK
#include "shaders/render/absorption_layers.hlsli"

Texture2D<float4> gLayers : register(t12);  // N_TT, N_TRT, N_R of a channel

FibreLobes fibreLobes(FibreConstants fibre, FibreFrame f, float3 tint, float3 absorption) {
    const float4 m = longitudinal(f.sinIn, f.sinOut);
    const float2 at = float2(0.5 * f.cosPhi + 0.5, m.w);
    FibreLobes lobes;
    [unroll] for (uint c = 0; c < 3u; ++c) {
        const float4 n = lookUpLayers(gLayers, at, absorption[c]);
        lobes.reflected[c] = m.x * n.z;
        lobes.through[c] = m.y * n.x * tint[c];
        lobes.returned[c] = m.z * n.y * tint[c] * tint[c];
    }
    return lobes;
}
#else
Texture2D<float4> gTransmitted : register(t12);  // N_TT, N_R in alpha
Texture2D<float4> gReflected : register(t13);    // N_TRT

FibreLobes fibreLobes(FibreConstants fibre, FibreFrame f, float3 tint, float3 absorption) {
    const float4 m = longitudinal(f.sinIn, f.sinOut);
    const float2 at = float2(0.5 * f.cosPhi + 0.5, m.w);
    FibreLobes lobes;
    lobes.reflected = lobes.through = lobes.returned = 0;
    if (fibre.rIntensity + fibre.ttIntensity > 0) {
        const float4 n = lookUp(gTransmitted, at);
        lobes.reflected = m.x * n.a;
        lobes.through = m.y * n.rgb * tint;
    }
    if (fibre.trtIntensity > 0) lobes.returned = m.z * lookUp(gReflected, at).rgb * (tint * tint);
    return lobes;
}
#endif

float3 fibreScattering(FibreConstants fibre, FibreFrame f, float strandRandom, float3 tint, float3 absorption) {
    const FibreLobes lobes = fibreLobes(fibre, f, tint, absorption);
    return lobes.reflected + lobes.through + lobes.returned;
}
