// SPDX-License-Identifier: GPL-3.0-or-later
// Sadeghi et al. 2010 from tables (Rünz 2012, section 6.6.2); core/shading/sadeghi.h is its reference. With
// HAIRLOOM_LOOK absorption changes from place to place and colours TT and TRT.
#include "shaders/render/fibre_tables.hlsli"

Texture2D<float4> gAzimuthal : register(t12);  // N' of R, TT and TRT, by the azimuth and the strand's glint
#ifdef HAIRLOOM_LOOK
#include "shaders/render/absorption_layers.hlsli"

Texture2D<float4> gEnergies : register(t13);  // of TT and TRT of a channel, by those of the material's absorption
#endif

// S' cos theta_i; `strandRandom` 0 to 1 is the place of the strand's glints.
float3 fibreScattering(FibreConstants fibre, FibreFrame f, float strandRandom, float3 tint, float3 absorption) {
    const float4 m = longitudinal(f.sinIn, f.sinOut);
    const float4 n = lookUp(gAzimuthal, float2(0.5 * f.cosPhi + 0.5, strandRandom));
    float3 tt = fibre.tt.rgb;
    float3 trt = fibre.trt.rgb;
#ifdef HAIRLOOM_LOOK
    [unroll] for (uint c = 0; c < 3u; ++c) {
        const float2 energies = lookUpLayers(gEnergies, float2(0.0, 0.0), absorption[c]).xy;
        tt[c] *= energies.x;
        trt[c] *= energies.y;
    }
#endif
    return m.x * n.x * fibre.r.rgb + m.y * n.y * tt * tint + m.z * n.z * trt * (tint * tint);
}
