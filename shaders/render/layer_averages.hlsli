// SPDX-License-Identifier: GPL-3.0-or-later
// What a fibre of any absorption sends on and back (shading::DualLayers::averages), for dual scattering.
#ifndef HAIRLOOM_LAYER_AVERAGES_HLSLI
#define HAIRLOOM_LAYER_AVERAGES_HLSLI
#include "shaders/render/absorption_layers.hlsli"

Texture2D<float4> gAverages : register(t15);

LayerAverages layerAverages(float thetaD, float absorption) {
    const LayerPlace place = layerPlace(absorption);
    return averagesBetween(sampleLayer(gAverages, thetaD, 0.0, place.low, 0.0, 1.0, 2.0),
                           sampleLayer(gAverages, thetaD, 0.0, place.low + 1.0, 0.0, 1.0, 2.0),
                           sampleLayer(gAverages, thetaD, 0.0, place.low, 1.0, 1.0, 2.0),
                           sampleLayer(gAverages, thetaD, 0.0, place.low + 1.0, 1.0, 1.0, 2.0), place.part);
}
#endif
