// SPDX-License-Identifier: GPL-3.0-or-later
// The cells of the grid that light is followed in.
#ifndef HAIRLOOM_LIGHT_CELLS_HLSLI
#define HAIRLOOM_LIGHT_CELLS_HLSLI
#include "shaders/shared/light_grid_types.h"

cbuffer Grid : register(b4) { LightGridConstants gGrid; };

int3 gridCells() { return int3(int(gGrid.sizeX), int(gGrid.sizeY), int(gGrid.sizeZ)); }
bool inGrid(int3 cell) { return !any(cell < int3(0, 0, 0)) && !any(cell >= gridCells()); }
uint cellNumber(int3 cell) { return uint(cell.x) + gGrid.sizeX * (uint(cell.y) + gGrid.sizeY * uint(cell.z)); }
#endif
