// SPDX-License-Identifier: MIT
// Between which layers of a table an absorption lies, of tables of several absorptions; core/shading/absorption_layers.h says what
// they hold.
#ifndef HAIRLOOM_FIBRE_LAYERS_HLSLI
#define HAIRLOOM_FIBRE_LAYERS_HLSLI
#include "layer_light.hlsli"

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

// Light that takes one path falls as exp(-sigma l), so logarithms are what changes evenly.
float4 betweenLayers(float4 low, float4 high, float part) {
    return exp(lerp(log(max(low, 1e-7)), log(max(high, 1e-7)), part));
}

// What a fibre of one absorption sends on and back.
struct LayerAverages {
    float4 shares;  // sent on, sent back, and their variances times them
    float2 tilts;   // of what is sent on and back, times them
    float2 moments;  // first and second, of the angle by which light is turned
};

// Of two rows each of the layers below and above.
LayerAverages averagesBetween(float4 lowShares, float4 highShares, float4 lowTilts, float4 highTilts, float part) {
    LayerAverages a;
    a.shares = betweenLayers(lowShares, highShares, part);
    a.tilts = lerp(lowTilts.xy, highTilts.xy, part);
    a.moments = betweenLayers(lowTilts, highTilts, part).zw - (a.shares.x + a.shares.y);
    return a;
}

// Of all channels, which have absorptions of their own.
FibreAverages averagesOf(LayerAverages r, LayerAverages g, LayerAverages b) {
    FibreAverages a;
    a.forward = float4(r.shares.x, g.shares.x, b.shares.x, 0.0);
    a.backward = float4(r.shares.y, g.shares.y, b.shares.y, 0.0);
    const float2 variance = r.shares.zw + g.shares.zw + b.shares.zw;
    const float2 tilt = r.tilts + g.tilts + b.tilts;
    a.moments.albedo = a.forward.rgb + a.backward.rgb;
    a.moments.first = float3(r.moments.x, g.moments.x, b.moments.x);
    a.moments.second = float3(r.moments.y, g.moments.y, b.moments.y);
    const float2 shares = max(float2(dot(a.forward.rgb, 1.0), dot(a.backward.rgb, 1.0)), 1e-6);
    a.forward.w = variance.x / shares.x;
    a.backward.w = variance.y / shares.y;
    const float all = shares.x + shares.y;
    a.rest = float4(tilt / shares, (tilt.x + tilt.y) / all, (variance.x + variance.y) / all);
    return a;
}
#endif
