// SPDX-License-Identifier: GPL-3.0-or-later
// Tables for hair whose absorption changes from place to place; core/shading/absorption_layers.h says what they hold.
#ifndef HAIRLOOM_ABSORPTION_LAYERS_HLSLI
#define HAIRLOOM_ABSORPTION_LAYERS_HLSLI
#include "shaders/render/fibre_tables.hlsli"

#define ABSORPTION_LAYERS 9
#define ABSORPTION_BEND 0.7
#define ABSORPTION_MAX 8.0

struct LayerPlace {
    float low, part;
};

float absorptionOfLayer(float layer) {
    const float u = layer / float(ABSORPTION_LAYERS - 1);
    return ABSORPTION_BEND * u / (1.0 + ABSORPTION_BEND / ABSORPTION_MAX - u);
}

LayerPlace layerPlace(float absorption) {
    const float sigma = clamp(absorption, 0.0, ABSORPTION_MAX);
    const float u = sigma * (1.0 + ABSORPTION_BEND / ABSORPTION_MAX) / (ABSORPTION_BEND + sigma);
    LayerPlace place;
    place.low = min(floor(u * float(ABSORPTION_LAYERS - 1)), float(ABSORPTION_LAYERS - 2));
    const float below = absorptionOfLayer(place.low);
    place.part = saturate((sigma - below) / (absorptionOfLayer(place.low + 1.0) - below));
    return place;
}

// Rows `from` ... `from` + `rows` - 1 of a layer's own `stride` rows, whose ends are the ends of v.
float4 sampleLayer(Texture2D<float4> table, float u, float v, float layer, float from, float rows, float stride) {
    const float2 size = sizeOf(table);
    const float2 at = float2(saturate(u) * (size.x - 1.0) + 0.5,
                             layer * stride + from + saturate(v) * (rows - 1.0) + 0.5);
    return table.SampleLevel(gLinear, at / size, 0);
}

// Light that takes one path falls as exp(-sigma l), so logarithms are what changes evenly.
float4 betweenLayers(float4 low, float4 high, float part) {
    return exp(lerp(log(max(low, 1e-7)), log(max(high, 1e-7)), part));
}

float4 lookUpLayers(Texture2D<float4> table, float2 at, float absorption) {
    const float rows = sizeOf(table).y / float(ABSORPTION_LAYERS);
    const LayerPlace place = layerPlace(absorption);
    return betweenLayers(sampleLayer(table, at.x, at.y, place.low, 0.0, rows, rows),
                         sampleLayer(table, at.x, at.y, place.low + 1.0, 0.0, rows, rows), place.part);
}
#endif
