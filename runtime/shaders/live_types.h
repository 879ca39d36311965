// SPDX-License-Identifier: MIT
// What the kernels around a frame of strands share with the program: the head and its roots before it, what
// is measured of hair after it. Metres, seconds; positions in world space unless they are said to be at rest.
#ifndef HAIRLOOM_LIVE_TYPES_H
#define HAIRLOOM_LIVE_TYPES_H
#include "types.h"

#ifdef __cplusplus
#include <cstddef>
namespace hairloom::shaders {
#endif

/// Threads of a work group of the kernels below.
#define HAIRLOOM_LIVE_GROUP 64
/// Words of what hair_extent.comp.hlsl reduces: least and greatest x, y, z as orderedFloat().
#define HAIRLOOM_EXTENT_WORDS 6
/// Words of what strands_measure.comp.hlsl reduces, which says what they are.
#define HAIRLOOM_MEASURE_WORDS 8

struct HeadConstants {
    uint count;    ///< vertices, or roots
    uint skinned;  ///< vertices: 0, and all go with the first bone
    uint bound;    ///< roots: 0, and all go with the first bone
    uint unused;
    float4 turn;  ///< of the first bone, as a quaternion; for roots that are not bound
};

/// A root of a strand at rest: x, y, z its position, and where on the head it is.
struct HeadRoot {
    float4 rest;
    float4 barycentric;  ///< w unused
    uint4 corners;       ///< vertices; w unused
};

struct RootRowConstants {
    uint slots;
    float moved;  ///< 1: roots have moved in this frame
    uint unused0, unused1;
};

struct ExtentConstants {
    uint points;
    uint threads;
    uint samples;     ///< points that are copied out
    uint sampleStep;  ///< from one of them to the next
};

struct MeasureConstants {
    uint points;
    uint spheres;
    float collisionRadiusAtRoot, collisionRadiusAtTip;
};

/// A point of a strand at rest.
struct MeasuredPoint {
    float segment;  ///< length of the segment that ends here; 0 at the root
    float mass;     ///< of the point in kg; 0 where it is clamped
    float along;    ///< 0 at the root … 1 at the tip
    float unused;
};

#ifdef __cplusplus
static_assert(sizeof(HeadConstants) == 32 && sizeof(HeadRoot) == 48 && sizeof(RootRowConstants) == 16);
static_assert(sizeof(ExtentConstants) == 16 && sizeof(MeasureConstants) == 16 && sizeof(MeasuredPoint) == 16);
}  // namespace hairloom::shaders
#else
/// Words in the order of the numbers that they stand for.
uint orderedFloat(float x) {
    const uint bits = asuint(x);
    return (bits & 0x80000000u) != 0u ? ~bits : bits | 0x80000000u;
}
#endif
#endif
