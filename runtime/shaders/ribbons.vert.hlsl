// SPDX-License-Identifier: MIT
#include "ribbon_strip.hlsli"

Ribbon main(uint vertex : SV_VertexID, uint hair : SV_InstanceID) { return ribbonAt(vertex, hair); }
