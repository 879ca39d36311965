// SPDX-License-Identifier: GPL-3.0-or-later
// Light between hairs where it falls, as light_grid_trace.comp.hlsl has followed it; docs/rendering.md says how.
#ifndef HAIRLOOM_LIGHT_GRID_HLSLI
#define HAIRLOOM_LIGHT_GRID_HLSLI
#include "runtime/shaders/dual_scattering.hlsli"
#include "shaders/shared/light_grid_types.h"

StructuredBuffer<float4> gLightGrid : register(t20);  // HAIRLOOM_GRID_FLOATS a cell

// What a fibre gets of light that hair or skin have scattered before.
struct GridLight {
    float3 light;  // of all directions, each times the cosine of its inclination
    float3 way;    // its mean direction, likewise; 0: from all around alike
    float square;  // mean square of the sine of its inclination
};

bool gridTells(ShadeConstants shade) { return shade.gridSize.w > 0u; }

// Cells around a place, of which the middle of the first is at `part` from 0 to 1 before it.
struct GridCorner {
    int3 cell;
    float3 part;
};

GridCorner gridCorner(ShadeConstants shade, float3 position_ws) {
    const float3 at = (position_ws - shade.gridOrigin_ws.xyz) * shade.gridOrigin_ws.w - 0.5;
    GridCorner corner;
    corner.cell = int3(floor(at));
    corner.part = at - float3(corner.cell);
    return corner;
}

struct GridCell {
    uint first;  // of its floats
    float weight;
};

GridCell gridCell(ShadeConstants shade, GridCorner corner, uint i) {
    const int3 beside = int3(int(i & 1u), int((i >> 1u) & 1u), int(i >> 2u));
    const int3 most = int3(int(shade.gridSize.x) - 1, int(shade.gridSize.y) - 1, int(shade.gridSize.z) - 1);
    const int3 cell = clamp(corner.cell + beside, int3(0, 0, 0), most);
    const float x = beside.x == 0 ? 1.0 - corner.part.x : corner.part.x;
    const float y = beside.y == 0 ? 1.0 - corner.part.y : corner.part.y;
    const float z = beside.z == 0 ? 1.0 - corner.part.z : corner.part.z;
    GridCell found;
    found.weight = x * y * z + 1e-6;
    found.first = HAIRLOOM_GRID_FLOATS * (uint(cell.x) + shade.gridSize.x * (uint(cell.y) + shade.gridSize.y * uint(cell.z)));
    return found;
}

// Of the cells around a place those that hold hair count.
GridLight gridLightAt(ShadeConstants shade, float3 position_ws) {
    const GridCorner corner = gridCorner(shade, position_ws);
    GridLight result;
    result.light = result.way = 0;
    result.square = 0;
    float weights = 0;
    float bright = 0;
    for (uint i = 0u; i < 8u; ++i) {
        const GridCell cell = gridCell(shade, corner, i);
        const float4 light = gLightGrid[cell.first];
        if (light.w < 0.0) continue;
        const float part = cell.weight * dot(light.rgb, 1.0 / 3.0);
        const float4 way = gLightGrid[cell.first + 1u];
        result.light += cell.weight * light.rgb;
        result.way += part * way.xyz;
        result.square += part * light.w;
        weights += cell.weight;
        bright += part;
    }
    result.light /= max(weights, 1e-6);
    result.way /= max(bright, 1e-20);
    result.square /= max(bright, 1e-20);
    return result;
}

// Irradiance of skin by light that hair or other skin has scattered.
float3 gridLightOnSkin(ShadeConstants shade, float3 position_ws) {
    const GridCorner corner = gridCorner(shade, position_ws);
    float3 light = 0;
    float weights = 0;
    for (uint i = 0u; i < 8u; ++i) {
        const GridCell cell = gridCell(shade, corner, i);
        const float4 skin = gLightGrid[cell.first + 2u];
        light += cell.weight * skin.w * skin.rgb;
        weights += cell.weight * skin.w;
    }
    return light / max(weights, 1e-6);
}

// What leaves a fibre towards the view of light from its neighbours: around itself as its first moment tells, along itself by a
// Gaussian around where that light goes, whose integral with the cosine squared is 1.
float3 gridScattering(GridLight light, FibreAverages across, float3 tint, float3 tangent, float3 toView) {
    const float3 share = shareOf(across.moments, tint);
    const float sinOut = clamp(dot(toView, tangent), -1.0, 1.0);
    const float3 viewAcross = toView - sinOut * tangent;
    const float along = clamp(dot(light.way, tangent), -1.0, 1.0);
    const float3 wayAcross = light.way - along * tangent;
    const float turned = dot(wayAcross, viewAcross) * rsqrt(max(dot(viewAcross, viewAcross), 1e-6));
    const float3 around = max(share * (across.moments.albedo + 2.0 * across.moments.first * turned), 0.0) / 6.2831853;
    const float middle = asin(along) + 2.0 * across.rest.z;
    const float variance = clamp(light.square - along * along + 4.0 * across.rest.w, 0.002, 0.5);
    const float x = asin(sinOut) - middle;
    const float whole = sqrt(6.2831853 * variance) * 0.5 * (1.0 + cos(2.0 * middle) * exp(-2.0 * variance));
    return light.light * around * (exp(-0.5 * x * x / variance) / max(whole, 1e-3));
}
#endif
