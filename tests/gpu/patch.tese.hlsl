// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/gpu/patch.hlsli"

[domain("tri")]
float4 main(Factors factors, float3 share : SV_DomainLocation, const OutputPatch<Corner, 3> corners) : SV_Position {
    return float4(corners[0].position * share.x + corners[1].position * share.y + corners[2].position * share.z, 1);
}
