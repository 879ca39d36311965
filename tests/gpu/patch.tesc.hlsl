// SPDX-License-Identifier: GPL-3.0-or-later
// Cuts each edge of a triangle into four.
#include "tests/gpu/patch.hlsli"

Factors factors(InputPatch<Corner, 3> corners) {
    Factors factors;
    factors.edge[0] = factors.edge[1] = factors.edge[2] = factors.inside = 4.0;
    return factors;
}

[domain("tri")]
[partitioning("integer")]
[outputtopology("triangle_cw")]
[outputcontrolpoints(3)]
[patchconstantfunc("factors")]
Corner main(InputPatch<Corner, 3> corners, uint i : SV_OutputControlPointID) { return corners[i]; }
