// SPDX-License-Identifier: GPL-3.0-or-later
// Tables for hair whose absorption changes from place to place; core/shading/absorption_layers.h says what they hold.
#ifndef HAIRLOOM_ABSORPTION_LAYERS_HLSLI
#define HAIRLOOM_ABSORPTION_LAYERS_HLSLI
#include "runtime/shaders/fibre_layers.hlsli"
#include "shaders/render/fibre_tables.hlsli"

// Rows `from` ... `from` + `rows` - 1 of a layer's own `stride` rows, whose ends are the ends of v.
float4 sampleLayer(Texture2D<float4> table, float u, float v, float layer, float from, float rows, float stride) {
    const float2 size = sizeOf(table);
    const float2 at = float2(saturate(u) * (size.x - 1.0) + 0.5,
                             layer * stride + from + saturate(v) * (rows - 1.0) + 0.5);
    return table.SampleLevel(gLinear, at / size, 0);
}

float4 lookUpLayers(Texture2D<float4> table, float2 at, float absorption) {
    const float rows = sizeOf(table).y / float(ABSORPTION_LAYERS);
    const LayerPlace place = layerPlace(absorption);
    return betweenLayers(sampleLayer(table, at.x, at.y, place.low, 0.0, rows, rows),
                         sampleLayer(table, at.x, at.y, place.low + 1.0, 0.0, rows, rows), place.part);
}
#endif
