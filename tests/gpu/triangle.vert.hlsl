// SPDX-License-Identifier: GPL-3.0-or-later
float4 main(float3 position : POSITION) : SV_Position { return float4(position, 1); }
