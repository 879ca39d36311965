// SPDX-License-Identifier: GPL-3.0-or-later
// Cells in which light between hairs is followed. Lengths in cells unless a unit is given, world space (_ws).
#ifndef HAIRLOOM_LIGHT_GRID_TYPES_H
#define HAIRLOOM_LIGHT_GRID_TYPES_H
#include "shaders/shared/render_types.h"
#ifdef __cplusplus
namespace hairloom::shaders {
#endif

// Whole numbers of a cell, so that sums do not depend on the order. What lies in it: of hair the area that it shades across its
// axis, and times that the tangent (3), albedo (RGB), first and second moments (RGB each), tilt and variance; of skin its
// area, and times that the normal (3) and the distance from the middle of the cell.
#define HAIRLOOM_GRID_TANGENT 1
#define HAIRLOOM_GRID_ALBEDO 4
#define HAIRLOOM_GRID_FIRST 7
#define HAIRLOOM_GRID_SECOND 10
#define HAIRLOOM_GRID_TILT 13
#define HAIRLOOM_GRID_VARIANCE 14
#define HAIRLOOM_GRID_SKIN 15
#define HAIRLOOM_GRID_CELL_WORDS 20
// And of light that has been scattered: what fibres get of it (RGB), which way that goes (3), its square along the fibres, and
// what meets the skin (RGB).
#define HAIRLOOM_GRID_LIGHT_WORDS 10
// As shading reads it: float4 each.
#define HAIRLOOM_GRID_FLOATS 3

struct LightGridConstants {
    float4 origin_ws;  // lower corner; w: metres along a cell's side
    float4 skin;       // linear RGB, albedo
    uint sizeX, sizeY, sizeZ;
    uint photons;
    float hairUnit;    // of the whole numbers a square metre of hair
    float skinUnit;    // and of skin
    float lightUnit;   // of a photon's whole light
    float power;       // watts (of the unit of irradiance) of a photon
    float clumping;    // fibres in the way by those that are counted
    uint count;        // of what a kernel works on: curve points, triangles, photons or cells
    uint rowThreads;   // of the dispatch
    float spread;      // cells that hair is spread over on either side, where a cell has few hairs; else 0
    // Photons before those of each light, in order; behind the lights those of the sky.
    uint4 before[5];
};
HAIRLOOM_OFFSET(LightGridConstants, before, 80);

#ifdef __cplusplus
}  // namespace hairloom::shaders
#endif
#endif
