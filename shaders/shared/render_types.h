// SPDX-License-Identifier: GPL-3.0-or-later
// What core/render and its shaders exchange. Lengths in metres, world space (_ws), Y up.
#ifndef HAIRLOOM_SHARED_RENDER_TYPES_H
#define HAIRLOOM_SHARED_RENDER_TYPES_H
#include "shaders/shared/types.h"
#ifdef __cplusplus
namespace hairloom::shaders {
#define HAIRLOOM_OFFSET(type, member, offset) static_assert(offsetof(type, member) == (offset))
#else
#define HAIRLOOM_OFFSET(type, member, offset)
#endif

#define HAIRLOOM_MAX_LIGHTS 3

// One strand as it was given: a run of points, and where its finer curve goes.
struct StrandHeader {
    uint firstPoint;  // in the batch's own arrays
    uint pointCount;
    uint segmentsBefore;  // of the batch's strands before it, as given
    float random;         // 0…1, the strand's own
    float4 albedo;        // linear RGB, w: 1 where it is the strand's own, 0 where the material's counts
    uint source;          // its place among the strands of its group
    uint unused0;
    uint unused1;
    uint unused2;
};

// One point of the finer curve.
struct CurvePoint {
    float4 position_ws;  // w: radius
    uint tangentXy;      // two snorm16 of an octahedral unit vector, root to tip
    float along;         // 0 root … 1 tip
    uint strand;
    uint unused;
};

struct CurveConstants {
    uint strandCount;
    uint subdivisions;    // curve segments per given segment
    uint floatsPerPoint;  // of the positions
    uint strandMajor;  // 0: points of a strand one after the other; else point p of strand s of the group at
                       // element p * strandMajor + s
    float4
        radius;  // x: metres at the root, y: of the tip by that of the root, z: 1 when points have their own
};

// Projection of strands or mesh, for the camera or for a light.
struct ViewConstants {
    float4x4 clipFromWorld;
    float4 eye_ws;   // w = 1: position of a perspective eye; w = 0: direction towards an orthographic one
    float4 pixel;    // x: world size of a pixel at distance 1 (w = 1) or anywhere (w = 0); y: least width in
                     // pixels
    uint4 sampling;  // x: samples a pixel, y: frame number
    float4 layers;   // ends of the opacity layers behind the first hair, in metres
    float4 range;    // x: depth range of the light's frustum in metres
};

struct LightConstants {
    float4x4 clipFromWorld;
    float4 toLight_ws;  // unit
    float4 irradiance;  // linear RGB, perpendicular to the light
    float4 tile;        // x: left edge of the light's square in the atlas, as a part of its width
    float4 range;       // x: depth range of the frustum in metres, y: 1 when it casts shadows
};

struct ShadeConstants {
    float4 eye_ws;
    float4 ambientSky;     // linear RGB radiance from above
    float4 ambientGround;  // and from below
    float4 primary;        // RGB strength of the first highlight, w: exponent
    float4 secondary;      // RGB strength of the second, multiplied by the albedo; w: exponent
    float4 shift;  // x, y: tilt of the two highlights (tangent of the angle), z: diffuse share, w: scattering
    float4 normalisation;  // x: 1/(pi R_O(0)), y, z: 1/(pi R_O(m)) of the two highlights
    float4 rootTip;        // x: brightness at the root, y: at the tip, z: random variation, w: fibre opacity
    float4 layers;         // as in ViewConstants
    float4 albedo;         // linear RGB of strands without a colour of their own
    uint4 counts;          // x: curve points, y: lights, z: row length of the dispatch in points
    LightConstants lights[HAIRLOOM_MAX_LIGHTS];
};

struct MeshConstants {
    float4x4 clipFromWorld;
    float4 skin;  // x: wrap, y: specular strength, z: specular exponent
};

struct ToneConstants {
    float4 exposure;  // x: factor on the light, y: on the sum of frames, z: 1 when the shader encodes sRGB
                      // itself
};

// Marks over the picture: OverlayShape says what `shape` means.
struct OverlayConstants {
    float4x4 clipFromWorld;
    float4
        viewport;  // x, y: size in pixels, z: 1 when colours stay sRGB, w: half the size of a mark in pixels
    uint4 shape;   // x: 0 points, 1 lines, 2 triangles; y: first vertex
};

struct OverlayVertex {
    float4 position_ws;
    float4 colour;
};

// One case for the shader's Kajiya-Kay, as tests feed it.
struct KajiyaCase {
    float4 tangent;
    float4 toLight;  // w: exponent
    float4 toView;   // w: 1/(pi R_O(exponent))
};

#ifdef __cplusplus
HAIRLOOM_OFFSET(StrandHeader, random, 12);
HAIRLOOM_OFFSET(StrandHeader, albedo, 16);
HAIRLOOM_OFFSET(StrandHeader, source, 32);
static_assert(sizeof(StrandHeader) == 48);
HAIRLOOM_OFFSET(CurvePoint, tangentXy, 16);
HAIRLOOM_OFFSET(CurvePoint, along, 20);
HAIRLOOM_OFFSET(CurvePoint, strand, 24);
static_assert(sizeof(CurvePoint) == 32);
static_assert(sizeof(CurveConstants) == 32);
HAIRLOOM_OFFSET(ViewConstants, eye_ws, 64);
HAIRLOOM_OFFSET(ViewConstants, pixel, 80);
HAIRLOOM_OFFSET(ViewConstants, sampling, 96);
HAIRLOOM_OFFSET(ViewConstants, layers, 112);
HAIRLOOM_OFFSET(ViewConstants, range, 128);
static_assert(sizeof(ViewConstants) == 144);
HAIRLOOM_OFFSET(LightConstants, toLight_ws, 64);
HAIRLOOM_OFFSET(LightConstants, range, 112);
static_assert(sizeof(LightConstants) == 128);
HAIRLOOM_OFFSET(ShadeConstants, shift, 80);
HAIRLOOM_OFFSET(ShadeConstants, layers, 128);
HAIRLOOM_OFFSET(ShadeConstants, albedo, 144);
HAIRLOOM_OFFSET(ShadeConstants, counts, 160);
HAIRLOOM_OFFSET(ShadeConstants, lights, 176);
static_assert(sizeof(ShadeConstants) == 176 + 128 * HAIRLOOM_MAX_LIGHTS);
static_assert(sizeof(MeshConstants) == 80);
static_assert(sizeof(ToneConstants) == 16);
static_assert(sizeof(OverlayConstants) == 96);
static_assert(sizeof(OverlayVertex) == 32);
static_assert(sizeof(KajiyaCase) == 48);
}  // namespace hairloom::shaders
#endif
#endif
