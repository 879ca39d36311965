// SPDX-License-Identifier: GPL-3.0-or-later
// Sadeghi et al. 2010 from tables (Rünz 2012, section 6.6.2); core/shading/sadeghi.h is its reference.
#include "shaders/fibre_tables.hlsli"

Texture2D<float4> gAzimuthal : register(t12);  // N' of R, TT and TRT, by the azimuth and the strand's glint

// S' cos theta_i; `strandRandom` 0 to 1 is the place of the strand's glints.
float3 fibreScattering(FibreConstants fibre, FibreFrame f, float strandRandom, float3 tint) {
    const float4 m = longitudinal(f.sinIn, f.sinOut);
    const float4 n = lookUp(gAzimuthal, float2(0.5 * f.cosPhi + 0.5, strandRandom));
    return m.x * n.x * fibre.r.rgb + m.y * n.y * fibre.tt.rgb * tint + m.z * n.z * fibre.trt.rgb * (tint * tint);
}
