// SPDX-License-Identifier: MIT
// Light at a fibre (Marschner et al. 2003; Rünz 2012, section 5.2). Unit vectors point away from it, the tangent from root to tip.
#ifndef HAIRLOOM_FIBRE_HLSLI
#define HAIRLOOM_FIBRE_HLSLI

struct FibreFrame {
    float sinIn, sinOut, cosPhi;
};

// Rünz 2012, Eq. 57.
FibreFrame fibreFrame(float3 tangent, float3 toLight, float3 toView) {
    FibreFrame f;
    f.sinIn = dot(toLight, tangent);
    f.sinOut = dot(toView, tangent);
    const float3 acrossIn = toLight - f.sinIn * tangent;
    const float3 acrossOut = toView - f.sinOut * tangent;
    f.cosPhi = dot(acrossIn, acrossOut) * rsqrt(max(dot(acrossIn, acrossIn) * dot(acrossOut, acrossOut), 1e-12));
    return f;
}

// S cos theta_i of M (R, TT, TRT, with cos theta_i / cos^2 theta_d) and N (TT, TRT, R) of a channel. `tint` is taken once by light
// that crosses the fibre, twice by TRT.
float marschner(float3 m, float3 n, float tint) { return m.x * n.z + m.y * n.x * tint + m.z * n.y * tint * tint; }
#endif
