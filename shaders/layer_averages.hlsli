// SPDX-License-Identifier: GPL-3.0-or-later
// What a fibre of any absorption sends on and back (shading::DualLayers::averages), for dual scattering and for light from
// everywhere.
#ifndef HAIRLOOM_LAYER_AVERAGES_HLSLI
#define HAIRLOOM_LAYER_AVERAGES_HLSLI
#include "shaders/absorption_layers.hlsli"

Texture2D<float4> gAverages : register(t15);

struct LayerAverages {
    float4 shares;  // sent on, sent back, and their variances times them
    float3 tilts;   // of what is sent on and back, times them; z: share of light from everywhere that leaves
};

LayerAverages layerAverages(float thetaD, float absorption) {
    const LayerPlace place = layerPlace(absorption);
    LayerAverages a;
    a.shares = betweenLayers(sampleLayer(gAverages, thetaD, 0.0, place.low, 0.0, 1.0, 2.0),
                             sampleLayer(gAverages, thetaD, 0.0, place.low + 1.0, 0.0, 1.0, 2.0), place.part);
    a.tilts = lerp(sampleLayer(gAverages, thetaD, 0.0, place.low, 1.0, 1.0, 2.0).xyz,
                   sampleLayer(gAverages, thetaD, 0.0, place.low + 1.0, 1.0, 1.0, 2.0).xyz, place.part);
    return a;
}

float3 ambientOf(float3 absorption) {
    return float3(layerAverages(0.0, absorption.x).tilts.z, layerAverages(0.0, absorption.y).tilts.z,
                  layerAverages(0.0, absorption.z).tilts.z);
}
#endif
