// SPDX-License-Identifier: GPL-3.0-or-later
cbuffer Constants : register(b0) { float4 gAmount; };
float4 main() : SV_Target0 { return gAmount; }
