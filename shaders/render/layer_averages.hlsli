// SPDX-License-Identifier: GPL-3.0-or-later
// What a fibre of any absorption sends on and back (shading::DualLayers::averages), for dual scattering.
#ifndef HAIRLOOM_LAYER_AVERAGES_HLSLI
#define HAIRLOOM_LAYER_AVERAGES_HLSLI
#include "shaders/render/absorption_layers.hlsli"

Texture2D<float4> gAverages : register(t15);

struct LayerAverages {
    float4 shares;  // sent on, sent back, and their variances times them
    float2 tilts;   // of what is sent on and back, times them
    float2 moments;  // first and second, of the angle by which light is turned
};

LayerAverages layerAverages(float thetaD, float absorption) {
    const LayerPlace place = layerPlace(absorption);
    LayerAverages a;
    a.shares = betweenLayers(sampleLayer(gAverages, thetaD, 0.0, place.low, 0.0, 1.0, 2.0),
                             sampleLayer(gAverages, thetaD, 0.0, place.low + 1.0, 0.0, 1.0, 2.0), place.part);
    const float4 low = sampleLayer(gAverages, thetaD, 0.0, place.low, 1.0, 1.0, 2.0);
    const float4 high = sampleLayer(gAverages, thetaD, 0.0, place.low + 1.0, 1.0, 1.0, 2.0);
    a.tilts = lerp(low.xy, high.xy, place.part);
    a.moments = betweenLayers(low, high, place.part).zw - (a.shares.x + a.shares.y);
    return a;
}
#endif
