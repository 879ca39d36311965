// SPDX-License-Identifier: GPL-3.0-or-later
#include "shaders/ribbon.hlsli"

cbuffer Constants : register(b0) { ViewConstants gView; };
StructuredBuffer<CurvePoint> gCurve : register(t0);

float4 main(uint vertex : SV_VertexID) : SV_Position {
    return ribbonCorner(gView, gCurve[vertex >> 1u], (vertex & 1u) != 0).position;
}
