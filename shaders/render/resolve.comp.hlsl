// SPDX-License-Identifier: GPL-3.0-or-later
// The mean of a pixel's samples, added to the sum of frames.
#include "shaders/render/resolve.hlsli"

[numthreads(HAIRLOOM_LIST_GROUP, 1, 1)]
void main(uint3 id : SV_DispatchThreadID) {
    const uint pixel = id.x + id.y * gResolve.rowThreads;
    if (id.x >= gResolve.rowThreads || pixel >= gResolve.pixels) return;
    addToSum(pixel, meanOfSamples(pixel));
}
