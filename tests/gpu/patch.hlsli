// SPDX-License-Identifier: GPL-3.0-or-later
struct Corner {
    float3 position : POSITION;
};
struct Factors {
    float edge[3] : SV_TessFactor;
    float inside : SV_InsideTessFactor;
};
