// SPDX-License-Identifier: GPL-3.0-or-later
float4 main() : SV_Target0 { return float4(1, 0, 1, 1); }
