// SPDX-License-Identifier: GPL-3.0-or-later
// From the sum of frames to what a display is sent, by a table of a view (core/render/display_table.h).
#include "shaders/shared/display_types.h"
#include "shaders/render/tone_map.hlsli"

cbuffer Constants : register(b0) { DisplayConstants gDisplay; };
StructuredBuffer<float4> gSum : register(t0);
StructuredBuffer<float4> gTable : register(t1);

float placeOf(float light) {
    return log2(1.0 + gDisplay.toe * clamp(light, 0.0, gDisplay.top)) * gDisplay.stretch;
}

// Between the corners of one of the six tetrahedra of a cell, the one around the greys.
float3 lookUp(float3 light) {
    const float3 place = float3(placeOf(light.x), placeOf(light.y), placeOf(light.z));
    const float last = float(gDisplay.side) - 2.0;
    const float3 cell = float3(min(floor(place.x), last), min(floor(place.y), last), min(floor(place.z), last));
    const float3 part = place - cell;
    const uint green = gDisplay.side;
    const uint blue = gDisplay.side * gDisplay.side;
    const uint first = uint(cell.x) + green * uint(cell.y) + blue * uint(cell.z);
    const bool redFirst = part.x >= part.y;
    const bool greenFirst = part.y >= part.z;
    const bool redThird = part.z > part.x;
    // Its way from the first corner to the last: along the channel with the largest part, then the next.
    uint one = blue;
    uint two = blue + green;
    float3 order = float3(part.z, part.y, part.x);
    if (redFirst) {
        if (greenFirst) {
            one = 1;
            two = 1 + green;
            order = float3(part.x, part.y, part.z);
        } else if (redThird) {
            two = blue + 1;
            order = float3(part.z, part.x, part.y);
        } else {
            one = 1;
            two = 1 + blue;
            order = float3(part.x, part.z, part.y);
        }
    } else if (greenFirst) {
        one = green;
        if (redThird) {
            order = float3(part.y, part.z, part.x);
        } else {
            two = green + 1;
            order = float3(part.y, part.x, part.z);
        }
    }
    const float4 shown = gTable[first] * (1.0 - order.x) + gTable[first + one] * (order.x - order.y) +
                         gTable[first + two] * (order.y - order.z) + gTable[first + 1 + green + blue] * order.z;
    return saturate(shown.rgb);
}

float4 main(float4 position : SV_Position) : SV_Target0 {
    const float4 sum = gSum[uint(position.y) * uint(gDisplay.width) + uint(position.x)];
    const float3 shown = lookUp(sum.rgb * gDisplay.scale);
    return float4(gDisplay.decodesSrgb > 0 ? decodeSrgb(shown) : shown, saturate(sum.a * gDisplay.alphaScale));
}
