// SPDX-License-Identifier: GPL-3.0-or-later
// Adds one frame to the sum.
Texture2D<float4> gFrame : register(t0);

float4 main(float4 position : SV_Position) : SV_Target0 { return gFrame.Load(int3(int2(position.xy), 0)); }
