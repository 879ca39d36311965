// SPDX-License-Identifier: MIT
// The fibres in a lamp's way: deep opacity maps (Yuksel and Keyser 2008) that kernels fill. Slices begin where hair begins in
// their column, and are the wider the deeper they lie.
#ifndef HAIRLOOM_LAMP_GRID_HLSLI
#define HAIRLOOM_LAMP_GRID_HLSLI
#include "hair_types.h"

// A fibre that covers a whole column counts so much.
#define FIBRE_COUNT 65536.0

uint columnAt(uint x, uint y) { return y * HAIR_COLUMNS + x; }
uint cellAt(uint column, uint slice) { return slice * (HAIR_COLUMNS * HAIR_COLUMNS) + column; }

// Behind the cells: where hair begins in the column.
uint firstAt(uint column) { return cellAt(column, HAIR_SLICES); }

// A depth 0 ... 1 as what is the greater the nearer it is; 0: there is no hair.
uint nearnessOf(float depth) { return 16777216u - uint(clamp(depth, 0.0, 1.0) * 16777215.0); }
float depthOf(uint nearness) { return float(16777216u - nearness) / 16777215.0; }

// Which slice lies so deep, and how far in it: 0 ... HAIR_SLICES.
float sliceOf(float depth) { return float(HAIR_SLICES) * sqrt(saturate(depth)); }

float3 gridPlace(HairLamp lamp, float3 position) {
    const float4 p = float4(position, 1.0);
    return float3(dot(lamp.across, p), dot(lamp.up, p), dot(lamp.away, p));
}

// The four columns around a place, and their shares.
struct Columns {
    uint4 at;
    float4 shares;
};

Columns columnsAround(float2 place) {
    const float2 at = place * float(HAIR_COLUMNS) - 0.5;
    const float2 low = floor(at);
    const float2 part = at - low;
    const float2 last = float2(HAIR_COLUMNS - 1, HAIR_COLUMNS - 1);
    const float2 a = clamp(low, 0.0, last), b = clamp(low + 1.0, 0.0, last);
    Columns c;
    c.at = uint4(columnAt(uint(a.x), uint(a.y)), columnAt(uint(b.x), uint(a.y)), columnAt(uint(a.x), uint(b.y)),
                 columnAt(uint(b.x), uint(b.y)));
    c.shares = float4((1.0 - part.x) * (1.0 - part.y), part.x * (1.0 - part.y), (1.0 - part.x) * part.y, part.x * part.y);
    return c;
}
#endif
