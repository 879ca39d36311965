// SPDX-License-Identifier: GPL-3.0-or-later
// Light from around on a fibre; core/shading/sky_light.h is the reference for a single one.
#ifndef HAIRLOOM_SKY_HLSLI
#define HAIRLOOM_SKY_HLSLI
#include "shaders/render/fibre_tables.hlsli"
#include "shaders/render/sky_in_hair.hlsli"
#ifdef HAIRLOOM_LOOK
#include "shaders/render/absorption_layers.hlsli"
#endif

Texture2D<float4> gSky : register(t17);  // moments of S cos theta_i by sin theta_o

struct SkyMoments {
    float3 even, along, across, alongAlong, alongAcross, acrossAcross, third;
};

#ifdef HAIRLOOM_LOOK
SkyMoments skyMoments(float sinOut, float3 absorption) {
    SkyMoments m;
    const float u = 0.5 * sinOut + 0.5;
    [unroll] for (uint c = 0; c < 3u; ++c) {
        const LayerPlace place = layerPlace(absorption[c]);
        const float4 low = sampleLayer(gSky, u, 0.0, place.low, 0.0, 1.0, 2.0);
        const float4 high = sampleLayer(gSky, u, 0.0, place.low + 1.0, 0.0, 1.0, 2.0);
        const float even = betweenLayers(low, high, place.part).x;
        const float3 one = even * lerp(low.yzw, high.yzw, place.part);
        const float3 two = even * lerp(sampleLayer(gSky, u, 0.0, place.low, 1.0, 1.0, 2.0).xyz,
                                       sampleLayer(gSky, u, 0.0, place.low + 1.0, 1.0, 1.0, 2.0).xyz, place.part);
        m.even[c] = even;
        m.along[c] = one.x;
        m.across[c] = one.y;
        m.alongAlong[c] = one.z;
        m.alongAcross[c] = two.x;
        m.acrossAcross[c] = two.y;
        m.third[c] = two.z;
    }
    return m;
}
#else
SkyMoments skyMoments(float sinOut, float3 absorption) {
    SkyMoments m;
    const float u = 0.5 * sinOut + 0.5;
    m.even = lookUp(gSky, float2(u, 0.0)).rgb;
    m.along = lookUp(gSky, float2(u, 1.0 / 6.0)).rgb;
    m.across = lookUp(gSky, float2(u, 2.0 / 6.0)).rgb;
    m.alongAlong = lookUp(gSky, float2(u, 3.0 / 6.0)).rgb;
    m.alongAcross = lookUp(gSky, float2(u, 4.0 / 6.0)).rgb;
    m.acrossAcross = lookUp(gSky, float2(u, 5.0 / 6.0)).rgb;
    m.third = lookUp(gSky, float2(u, 1.0)).rgb;
    return m;
}
#endif

// Light that is there mostly from one side has an edge that two harmonics do not show. From an even half of all directions
// the slope is 3/2 of the mean; around the fibre the second harmonic is 0 and the third -1/3 of the first. Deeper in black
// hair it narrows to a beam, where the slope is three times the mean, and around the fibre all are twice that. Between them
// they are taken to change with the slope.
float3 edgeOfSky(SkyMoments m, SkyInHair sky, float3 t, float3 f) {
    const float3 green = float3(sky.x.g, sky.y.g, sky.z.g);
    const float slope = length(green);
    const float3 axis = green / max(slope, 1e-6);
    const float3 steep = sqrt(sky.x * sky.x + sky.y * sky.y + sky.z * sky.z);
    const float3 narrow = saturate(steep / max(1.5 * sky.even, 1e-6) - 1.0);
    const float3 around = steep * lerp(8.0 / (3.0 * 3.14159265), 2.0 / 3.0, narrow);
    const float x = dot(axis, f);
    const float p = saturate(1.0 - dot(axis, t) * dot(axis, t));
    return m.acrossAcross * sky.even * (2.0 * narrow) * (2.0 * x * x - p) +
           m.third * around * ((4.0 * narrow - 1.0) / 3.0) * (4.0 * x * x * x - 3.0 * x * p);
}

// Light from around as it is inside hair, which leaves the fibre along `t` towards the view.
float3 environmentOnFibre(ShadeConstants shade, SkyMoments m, SkyInHair sky, float3 t, float3 toView) {
    const float3 side = toView - t * dot(toView, t);
    const float3 f = side * rsqrt(max(dot(side, side), 1e-12));
    const float3 flat = 0.28209479 * shade.environment[0].rgb;
    const float3 bx = 0.48860251 * shade.environment[3].rgb;
    const float3 by = 0.48860251 * shade.environment[1].rgb;
    const float3 bz = 0.48860251 * shade.environment[2].rgb;
    // Band 2 as a symmetric matrix.
    const float3 xy = 0.54627422 * shade.environment[4].rgb;
    const float3 yz = 0.54627422 * shade.environment[5].rgb;
    const float3 zx = 0.54627422 * shade.environment[7].rgb;
    const float3 zz = 0.63078313 * shade.environment[6].rgb;
    const float3 difference = 0.54627422 * shade.environment[8].rgb;
    const float3 xx = -0.5 * zz + difference;
    const float3 yy = -0.5 * zz - difference;
    const float3 qtx = xx * t.x + xy * t.y + zx * t.z;
    const float3 qty = xy * t.x + yy * t.y + yz * t.z;
    const float3 qtz = zx * t.x + yz * t.y + zz * t.z;
    const float3 qfx = xx * f.x + xy * f.y + zx * f.z;
    const float3 qfy = xy * f.x + yy * f.y + yz * f.z;
    const float3 qfz = zx * f.x + yz * f.y + zz * f.z;

    const float3 bt = bx * t.x + by * t.y + bz * t.z;
    const float3 bf = bx * f.x + by * f.y + bz * f.z;
    const float3 st = sky.x * t.x + sky.y * t.y + sky.z * t.z;
    const float3 sf = sky.x * f.x + sky.y * f.y + sky.z * f.z;
    // The product of both, up to the second order.
    const float3 mean = (bx * sky.x + by * sky.y + bz * sky.z) / 3.0;
    const float3 even = flat * sky.even + mean;
    const float3 along = bt * sky.even + flat * st + 0.4 * (qtx * sky.x + qty * sky.y + qtz * sky.z);
    const float3 across = bf * sky.even + flat * sf + 0.4 * (qfx * sky.x + qfy * sky.y + qfz * sky.z);
    const float3 tt = sky.even * (qtx * t.x + qty * t.y + qtz * t.z) + bt * st - mean;
    const float3 ff = sky.even * (qfx * f.x + qfy * f.y + qfz * f.z) + bf * sf - mean;
    const float3 tf = sky.even * (qtx * f.x + qty * f.y + qtz * f.z) + 0.5 * (bt * sf + bf * st);
    const float3 light = m.even * even + m.along * along + m.across * across + m.alongAlong * tt +
                         m.acrossAcross * (ff + 0.5 * tt) + 2.0 * m.alongAcross * tf + flat * edgeOfSky(m, sky, t, f);
    // Harmonics cut off fall below what R and TRT send back of light from the view's side: of half a sky a fifth of the mean
    // in blond hair, and more in darker.
    return max(light, 0.2 * m.even * flat * sky.even);
}
#endif
