// SPDX-License-Identifier: GPL-3.0-or-later
// Nothing in any pixel.
#include "shaders/render/surface.hlsli"

[numthreads(HAIRLOOM_LIST_GROUP, 1, 1)]
void main(uint3 id : SV_DispatchThreadID) {
    const uint pixel = id.x + id.y * gRaster.rowLength;
    if (id.x >= gRaster.rowLength || pixel >= gRaster.count) return;
    gNearest[pixel] = asuint(1.0);
    gItem[pixel] = 0xffffffffu;
    SurfacePixel nothing;
    nothing.depth = asfloat(0x7f800000u);
    nothing.strand = HAIRLOOM_NO_STRAND;
    nothing.velocityX = nothing.velocityY = 0;
    nothing.albedo = 0;
    nothing.pastDepth = nothing.depth;
    nothing.unused0 = nothing.unused1 = nothing.unused2 = 0;
    gFound[pixel] = nothing;
}
