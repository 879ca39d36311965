// SPDX-License-Identifier: GPL-3.0-or-later
// Light at a pixel of a ribbon that the device's rasteriser draws.
#include "shaders/render/across.hlsli"

// `mean`: of the whole width there. `pieces`: of a patch the curve point where it begins, and how many pieces it has; of a strip the
// curve point of the triangle's first vertex. `place`: x along: of patches curve points from there on, of strips 0 at even curve points
// and 1 at odd ones; y across, from side to side, -1 to 1.
float3 lightOn(ViewConstants view, float3 mean, uint2 pieces, float2 place) {
    const float reach = 0.5 * length(float2(ddx(place.y), ddy(place.y)));
    if (view.across == HAIRLOOM_ACROSS_NONE) return mean;
    if (view.across == HAIRLOOM_ACROSS_PATCHES) {
        const uint piece = min(uint(max(place.x, 0.0)), pieces.y - 1u);
        return lightOfHair(view, pieces.x + piece, saturate(place.x - float(piece)), place.y, reach);
    }
    const float along = (pieces.x & 1u) != 0u ? 1.0 - place.x : place.x;
    return lightOfHair(view, pieces.x, saturate(along), place.y, reach);
}
