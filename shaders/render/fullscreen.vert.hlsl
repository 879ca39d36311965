// SPDX-License-Identifier: GPL-3.0-or-later
// One triangle that covers the target.
float4 main(uint vertex : SV_VertexID) : SV_Position {
    return float4(vertex == 1 ? 3 : -1, vertex == 2 ? 3 : -1, 0, 1);
}
