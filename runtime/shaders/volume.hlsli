// SPDX-License-Identifier: MIT
// Hair against hair through a volume (docs/engine.md, after Petrovic, Henne and Anderson 2005): nodes at whole
// multiples of a cell. Sums are 64-bit integers in two halves, so that they are exact and equal in any order.
#include "volume_types.h"

cbuffer Volume : register(b0) { VolumeConstants gVolume; };

// Words of gBox: least and greatest position of all points and greatest component of a velocity as numbers that sort
// like their values, and how many points count.
#define BOX_LOW 0
#define BOX_HIGH 3
#define BOX_FASTEST 6
#define BOX_POINTS 7

#define FARTHEST 1e6   // metres; points beyond do not count
#define FASTEST 1000.0 // m/s that a component adds at most to a sum
#define SHARES 256     // steps of a cell
// Words of a node: mass in 2⁻²⁴ points, momentum in 2⁻²⁴ points · unit; each low and high half.
#define NODE_WORDS 8

/// Numbers that sort like the values.
uint sortable(float v) {
    const uint bits = asuint(v);
    return (bits & 0x80000000u) != 0u ? ~bits : bits | 0x80000000u;
}
float unsorted(uint bits) {
    return asfloat((bits & 0x80000000u) != 0u ? bits & 0x7fffffffu : ~bits);
}

/// The grid of the frame; every thread makes it from the box.
struct Grid {
    float cell;     // metres
    int3 origin;    // of the first node, in cells from the world's origin
    uint3 size;     // nodes along each axis
    float unit;     // m/s
};

Grid gridOf(uint box[8]) {
    Grid grid;
    const float3 low = float3(unsorted(box[0]), unsorted(box[1]), unsorted(box[2]));
    const float3 high = float3(unsorted(box[3]), unsorted(box[4]), unsorted(box[5]));
    grid.cell = gVolume.cellSize;
    grid.size = uint3(0, 0, 0);
    grid.origin = int3(0, 0, 0);
    grid.unit = 1.0;
    if (box[BOX_POINTS] == 0u) return grid;
    [loop] for (uint n = 0; n < 64; ++n) {
        // One more node than needed on each side carries the gradient.
        const float3 first = floor(low / grid.cell) - 1.0;
        const float3 count = floor(high / grid.cell) + 3.0 - first;
        if (count.x * count.y * count.z <= gVolume.maxNodes) {
            grid.origin = int3(first);
            grid.size = uint3(count);
            break;
        }
        grid.cell *= 2.0;
    }
    // Velocities of at most 2²³ units.
    const float fastest = max(asfloat(box[BOX_FASTEST]), 1e-30);
    grid.unit = exp2(ceil(log2(fastest)) - 23.0);
    return grid;
}

uint nodeCount(Grid grid) { return grid.size.x * grid.size.y * grid.size.z; }

/// Corner of a point's cell and its share of the way to the next, in 1/256, along each axis.
struct Place {
    uint3 corner, share;
};
Place placeOf(float3 position, Grid grid) {
    // Cells of the world first: the whole ones leave exactly.
    const float3 cells = position / grid.cell;
    const float3 whole = floor(cells);
    const uint3 steps = uint3(round((cells - whole) * float(SHARES)));
    const uint3 first = uint3(int3(whole) - grid.origin);
    Place place;
    place.corner = first + steps / SHARES;
    place.share = steps % SHARES;
    return place;
}
uint nodeOf(Place place, uint corner, Grid grid) {
    const uint3 at = place.corner + uint3(corner & 1u, (corner >> 1) & 1u, corner >> 2);
    return (at.z * grid.size.y + at.y) * grid.size.x + at.x;
}
/// Of one of the eight corners; they sum to 2²⁴.
uint weightOf(Place place, uint corner) {
    const uint3 far = place.share, near = SHARES - place.share;
    return ((corner & 1u) != 0u ? far.x : near.x) * ((corner & 2u) != 0u ? far.y : near.y) *
           ((corner & 4u) != 0u ? far.z : near.z);
}
