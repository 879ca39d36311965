// SPDX-License-Identifier: GPL-3.0-or-later
// What the cells of the grid hold, once all hair and skin is in them.
#ifndef HAIRLOOM_LIGHT_CELLS_READ_HLSLI
#define HAIRLOOM_LIGHT_CELLS_READ_HLSLI
#include "shaders/render/light_cells.hlsli"

StructuredBuffer<uint> gCells : register(t0);

float wordAt(uint word) { return float(int(gCells[word])); }
float3 threeAt(uint word) { return float3(wordAt(word), wordAt(word + 1u), wordAt(word + 2u)); }

// Sides of the skin in a cell that face each other, as of a lid or an ear: `normal` is the sum over its area.
bool isFolded(float3 normal, float area) { return length(normal) < 0.3 * area; }
#endif
