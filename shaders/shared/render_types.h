// SPDX-License-Identifier: GPL-3.0-or-later
// What core/render and its shaders exchange. Lengths in metres, world space (_ws), Y up.
#ifndef HAIRLOOM_SHARED_RENDER_TYPES_H
#define HAIRLOOM_SHARED_RENDER_TYPES_H
#include "runtime/shaders/look_types.h"
#include "shaders/shared/group_sizes.h"
#ifdef __cplusplus
namespace hairloom::shaders {
#define HAIRLOOM_OFFSET(type, member, offset) static_assert(offsetof(type, member) == (offset))
#else
#define HAIRLOOM_OFFSET(type, member, offset)
#endif

#define HAIRLOOM_MAX_LIGHTS 16
#define HAIRLOOM_CLOSE_MAPS 4
#define HAIRLOOM_ACROSS_CELLS 8  // parts of a hair's width that have light of their own

// Directions that the sky is seen from: the corners of an icosahedron, each with the one across from it.
#define HAIRLOOM_SKY_MAPS 12

// render::Shadows
#define HAIRLOOM_SHADOWS_NONE 0
#define HAIRLOOM_SHADOWS_DEEP_OPACITY 1
#define HAIRLOOM_SHADOWS_ABSORPTION 2
#define HAIRLOOM_SHADOWS_OPACITY_MAPS 3
#define HAIRLOOM_SHADOWS_ADAPTIVE 4

// One strand as it was given: a run of points, and where its finer curve goes.
struct StrandHeader {
    uint firstPoint;  // in the batch's own arrays
    uint pointCount;
    uint segmentsBefore;  // of the batch's strands before it, as given
    float random;         // 0…1, the strand's own
    float4 albedo;        // linear RGB, w: 1 where it is the strand's own, 0 where the material's counts
    uint source;          // its place among the strands of its group
    float streak;         // 0...1, how much it is in a streak
    float dye;            // 0...1
    uint hasPointDyes;    // 1 where its points have shares of that
    float pigment;        // 0...8, times that of the look
    float length;         // metres, for a dye that has grown out
    float unused0, unused1;
};

// One point of the finer curve.
struct CurvePoint {
    float4 position_ws;  // w: radius
    uint tangentXy;      // two snorm16 of an octahedral unit vector, root to tip
    float along;         // 0 root … 1 tip
    uint strand;
    float opacity;  // 0...1
};

// A run of a strand's given segments that one tessellated ribbon covers; devices cut it into 64 pieces at
// most.
#define HAIRLOOM_PATCH_SEGMENTS 21
struct StrandPatch {
    uint strand;  // in its batch
    uint firstSegment;
    uint segments;
    uint pointCount;  // of the strand
};

struct CurveConstants {
    uint strandCount;
    uint subdivisions;      // curve segments per given segment
    uint floatsPerPoint;    // of the positions
    uint firstPoint;        // of the batch, in the positions
    float rootRadius;       // metres
    float tipScale;         // radius at the tip by that at the root
    float radiusVariation;  // random spread from strand to strand, a part of the radius
    uint hasRadii;          // 1: points have their own
    float fullShare;        // share of the strands that have their full width
    float goneShare;        // share from which on they have none
    float strandShare;      // one by the number of strands
    float widening;
    float rootOpacity;
    float tipOpacity;
    float unused0, unused1;
};

struct PatchConstants {
    uint firstPatch;
    uint subdivisions;  // curve segments per given segment
    uint unused0, unused1;
    float width;  // of the view in pixels
    float height;
    float deviation;  // pixels that a piece of a ribbon may lie beside the curve
    float unused2;
};

// Projection of strands or mesh, for the camera or for a light.
// Whether hair has light that changes over its width, and how ribbons know where a pixel is on them.
#define HAIRLOOM_ACROSS_NONE 0
#define HAIRLOOM_ACROSS_PIECES 1
#define HAIRLOOM_ACROSS_PATCHES 2
struct ViewConstants {
    float4x4 clipFromWorld;
    float4 eye_ws;    // w = 1: position of a perspective eye; w = 0: direction towards an orthographic one
    float pixelSize;  // metres, at distance 1 (eye_ws.w = 1) or anywhere (0)
    float minWidth;   // pixels
    float fibresForEach;  // of a light: fibres that each of them stands for
    float eachHair;       // of a light: 1 where single hairs matter, and none may stand for others
    uint samples;  // in a pixel
    uint frame;    // its number
    uint across;   // of the camera: HAIRLOOM_ACROSS_*
    uint shadows;      // HAIRLOOM_SHADOWS_*
    float4 layers;     // of a light: see LightConstants
    float depthRange;  // of a light: see LightConstants
    float nearPlane;   // of a light
    float hairBegins;  // of a light: see there; of the camera: in metres, or as RibbonCorner::depth has it
    float hairDepth;   // of the camera: from where hair begins to its end, in the same unit
};

struct LightConstants {
    float4x4 clipFromWorld;
    float4 toLight_ws;  // w = 0: unit direction; w = 1: place of a point light
    float4 irradiance;  // linear RGB, perpendicular to the light; of a point light at 1 m
    float4 facing_ws;   // unit, of a point that is part of an area, whose light falls with the cosine; else 0
    float tileLeft;     // left edge of the light's square in the atlas, pixels
    float tileSize;     // of the square, pixels
    float headCasts;    // 1 where the head casts shadows
    float atlasWidth;   // pixels
    float depthRange;   // of the frustum, metres
    float shadows;      // HAIRLOOM_SHADOWS_*
    float nearPlane;    // of a perspective view, metres; 0 for an orthographic one
    float hairBegins;   // metres behind the near plane
    float4 layers;    // ends of three opacity layers in metres behind the first hair (w: the part of a texel
                      // that a fibre covers), or of four slices behind where hair begins; of other numbers of
                      // them that of the last, as z or w; absorption: x: fibres a metre, y: most fibres
    float stopping;   // exp(-stopping n) of the light passes n fibres that a texel counts
    float texelSize;  // metres
    float headAbsorption;  // of hair behind the head, 1/m; 0: a test of depth
    float withoutShadows;  // 1: shadows of the light itself are left out
    float filterTexels;    // a side of what is averaged: 1, 3 or 5
    float layerCount;      // of opacity, or nodes of transmittance
    float layerGrowth;     // of their widths from one to the next; 0: early ends (opacity.hlsli)
    // Texels between those that are averaged; below 1 the share of their mean in the light (occlusion()).
    float tapDistance;
    // Its finer map of what is near the camera, and how much of the light that tells; 0: it has none.
    float closeMap, closeShare;
    float unusedMap0, unusedMap1;
};

// Deep opacity maps of hair and depth maps of the head, as the sky sees them.
struct SkyConstants {
    LightConstants maps[HAIRLOOM_SKY_MAPS];
};

// What surrounds a strand's point, as shares of all directions; fibres stop light as such, and half as well.
// Eight 16-bit shares: open to the sky; its mean direction, times 3, from -1 to 1; the head; its direction.
struct SkyPoint {
    uint4 whole;
    uint4 halved;
};

struct ShadeConstants {
    float4 eye_ws;  // w = 1: position of a perspective eye; w = 0: direction towards an orthographic one
    float4 environment[9];  // radiance from around as real spherical harmonics, linear RGB
    // Of Kajiya-Kay.
    float4 primary;    // RGB strength of the first highlight
    float4 secondary;  // and of the second, multiplied by the albedo
    float primaryExponent;
    float secondaryExponent;
    float primaryTilt;  // tangent of the angle by which the first highlight is shifted
    float secondaryTilt;
    float diffuse;               // share
    float scattering;            // light that other fibres pass on
    float diffuseNormalisation;  // 1/(pi R_O(0))
    float primaryNormalisation;  // 1/(pi R_O(m)) of the first highlight
    float secondaryNormalisation;
    float rootBrightness;
    float tipBrightness;
    float brightnessVariation;  // random
    float4 albedo;              // linear RGB of strands without a colour of their own
    float4 ground;              // linear RGB, albedo of what hair grows on
    // Light on its way through hair to the skin (shading::AverageScattering). RGB.
    float4 scattered;    // the share that a fibre scatters; of Kajiya-Kay what it takes, as the logarithm
    float4 firstMoment;  // of the angle by which fibres turn light
    float4 secondMoment;
    float clumping;       // fibres in the way by those that are counted
    uint ofFibres;        // 0 for Kajiya-Kay
    uint hasEnvironment;  // 1: there is light from around
    uint hasSkyMaps;      // 1: maps hold what of the sky is seen
    float fibreOpacity;
    uint bounded;         // 1: Kajiya-Kay sends out no more light than it gets
    float brightestTint;  // of a strand of light in fibres: more would be whiter than white
    float axisRatio;      // of Kajiya-Kay's elliptic fibres; 1: round
    uint count;           // of what a kernel works on: points of curves, or strands
    uint lightCount;
    uint rowThreads;    // of the dispatch
    uint subdivisions;  // curve segments per given segment
    float ownWidth;     // of a hair by that of its ribbon, which may stand for several
    float acrossShare;  // how much of what changes over a hair's width is shown
    float unused0, unused1;
    // Of the grid that light between hairs was followed in: lower corner, and w: cells a metre.
    float4 gridOrigin_ws;
    uint4 gridSize;  // cells along x, y and z; w: 1 where there is one
    LightConstants lights[HAIRLOOM_MAX_LIGHTS];
    LightConstants closeMaps[HAIRLOOM_CLOSE_MAPS];
};

// What the models of light in fibres take beside their tables.
struct FibreConstants {
    float rIntensity;
    float ttIntensity;
    float trtIntensity;
    float ior;          // and two more of the section that paths cross
    float4 r;  // Sadeghi's: colour times intensity, linear RGB
    float4 tt;
    float4 trt;
    float minSpread;  // width of the table of wide lobes, radians
    float maxSpread;
    float azimuthalWidth;  // standard deviation, radians
    float unused0;
    float4 absorption;  // per fibre radius, linear RGB
};

// Where compute kernels that rasterise put what they find.
#define HAIRLOOM_MAX_SAMPLES 8
struct RasterConstants {
    float4 window;      // xy: upper left corner of what is drawn, in pixels of the buffer; zw: its size
    uint count;         // curve points, or triangles
    uint rowLength;     // of the dispatch, in threads; of triangles in groups
    uint bufferWidth;   // pixels
    uint phase;         // HAIRLOOM_PHASE_*
    uint samples;       // in a pixel
    uint layers;        // of opacity
    uint slices;        // that a triangle is cut into
    uint sorts;         // 1: hair is kept as each pixel's nearest fragments
    float sampleReach;  // farthest that a sample lies from the middle of its pixel along x or y, pixels
    float layerGrowth;  // of opacity: see LightConstants
    uint fragments;     // that lists hold
    uint square;        // number of the light's
    float4
        samplePositions[HAIRLOOM_MAX_SAMPLES / 2];  // of the samples from the middle, in pixels, two in each
};
// Of a pixel, that are blended in their order.
#define HAIRLOOM_FRAGMENTS 8
// Of a pixel: its fragments' cover, 16 bits each, then by how often all hair in it halves what lies behind,
// in steps.
#define HAIRLOOM_COVER_WORDS (HAIRLOOM_FRAGMENTS / 2 + 1)
#define HAIRLOOM_HALVING_STEPS 512
#define HAIRLOOM_PHASE_NEAREST 0
#define HAIRLOOM_PHASE_LIGHT 1
// Where they tell what is nearest in the middle of a pixel: which of what has the least depth, and all about
// it.
#define HAIRLOOM_PHASE_ITEM 2
#define HAIRLOOM_PHASE_TELL 3

// Where they list what a light's texels have: first they count it all, then they link it.
#define HAIRLOOM_PHASE_COUNT 0
#define HAIRLOOM_PHASE_LINK 1
// Of a piece of hair in a texel: its depth as bits, how much of a fibre it is, and the number of what was
// linked before it, from 1; 0: nothing.
#define HAIRLOOM_LISTED_WORDS 3
// Pieces of hair in a texel's list at most: one thread sorts them. A device ends what takes seconds, and
// Mesa's llvmpipe leaves all loops of a thread after 65,535 turns together, of which these take 45,000.
#define HAIRLOOM_LISTED_OF_TEXEL 2048
#define HAIRLOOM_MAX_SHADOW_NODES 16

#define HAIRLOOM_NO_STRAND 0xffffffff
struct SurfacePixel {
    float depth;      // metres along the view; infinite where nothing is
    uint strand;      // number of the hair; HAIRLOOM_NO_STRAND on a mesh and where nothing is
    float velocityX;  // pixels that it has moved since a frame ago, to the right
    float velocityY;  // and down
    float4 albedo;    // linear RGB; w: 0 where nothing is
    float pastDepth;  // metres along the view of a frame ago
    float unused0, unused1, unused2;
};

// What is known of a pixel for the frame after it.
struct TemporalPixel {
    float depth;   // as SurfacePixel
    uint strand;   // likewise
    float frames;  // that its light is the mean of, as far as they count
    float albedo;  // 0 where nothing is
};

struct TemporalConstants {
    uint width;  // pixels
    uint height;
    uint hasPast;  // 0: nothing is known of a frame before
    float most;    // frames that count
    uint moves;    // 1 where hair, head, camera or light are not as a frame ago
    uint unused0, unused1, unused2;
};

// How to tell it.
struct SurfaceConstants {
    float4x4 clipFromWorld;
    float4x4 pastClipFromWorld;  // of a frame ago
    float4 forward_ws;           // times a place (x, y, z, 1): metres along the view
    float4 pastForward_ws;       // of a frame ago
    uint firstItem;              // number of a batch's first curve point or a mesh's first triangle among all
    uint firstStrand;            // number of a group's first strand among all
    uint pastStrands;            // of the batch whose places of a frame ago are known; of a mesh 1 or 0
    uint unused0;
};

struct FillConstants {
    uint value;
    uint elements;
    uint rowThreads;  // of the dispatch
    uint unused0;
};

// From samples to pixels.
struct ResolveConstants {
    uint pixels;
    uint rowThreads;    // of the dispatch
    uint samples;       // in a pixel
    uint sumBegins;     // 1: with this frame
    float4 background;  // linear RGB and coverage
};

// From counted fibres to a light's square of the opacity map.
struct PackConstants {
    uint side;         // of the square, pixels
    uint tileLeft;     // its left edge in the atlas, pixels
    uint atlasWidth;   // pixels
    uint shadows;      // HAIRLOOM_SHADOWS_*
    float depthRange;  // see LightConstants
    float nearPlane;
    uint layers;  // of opacity, or nodes
    uint words;   // of a texel's shares, two in each
};

struct MeshConstants {
    float4x4 clipFromWorld;
    float wrap;      // share of the half turned away that light reaches
    float specular;  // strength
    float specularExponent;
    float unused0;
};

struct ToneConstants {
    float exposure;     // factor on the light
    float frameShare;   // factor on the sum of frames
    float encodesSrgb;  // 1 when the shader does so itself
    float width;        // pixels in a row
};

// Shadows blurred on the screen, along rows first.
struct BlurConstants {
    uint width;  // of the picture, pixels
    uint height;
    uint alongColumns;  // 0 along rows
    uint reach;         // pixels
    float falloff;      // -1 by twice the variance, 1/pixel^2
    float unused0, unused1, unused2;
};

struct FilterConstants {
    float width;  // of the picture, pixels
    float height;
    float texelWidth;  // one by them
    float texelHeight;
    float keepsSrgb;   // 1 when colours stay sRGB
    float longSearch;  // 1 for the long search
    float unused0, unused1;
};

// Marks over the picture: OverlayShape says what `shape` means.
struct OverlayConstants {
    float4x4 clipFromWorld;
    float width;  // of the view, pixels
    float height;
    float keepsSrgb;   // 1 when colours stay sRGB
    float markRadius;  // half the size of a mark, pixels
    uint shape;        // 0 points, 1 lines, 2 triangles
    uint firstVertex;
    uint unused0, unused1;
};

struct OverlayVertex {
    float4 position_ws;
    float4 colour;
};

// One place for what lights do, as tests feed it.
struct LightCase {
    float4 position_ws;  // w: metres of hair towards the light that are left out
    float4 direction;    // unit
};

struct LightAnswer {
    float4 onHair;  // light from around for a fibre; w: fibres in front of it
    float4 onSkin;  // light from around for a surface; w: what the head lets through
    float4 sky;     // x: share of all directions that sees the sky, y: that sees the head; z: what hair lets
                    // through
};

// One case for the shader's Kajiya-Kay, as tests feed it.
struct KajiyaCase {
    float4 tangent;
    float4 toLight;  // w: exponent
    float4 toView;   // w: 1/(pi R_O(exponent))
};

// One case for the shaders' models of light in fibres.
struct FibreCase {
    float4 tangent;  // w: the strand's random number
    float4 toLight;  // w: fibres before the point
    float4 toView;   // w: all fibres
    float4 ground;   // albedo of what lies behind them
    float4 place;    // x: 0 root ... 1 tip, y: streak, z: dye, w: the strand's random number of absorption
    float4 own;      // the strand's own colour; w: 1 where it has one
    float4 strand;   // x: pigment, y: length in metres
};

#ifdef __cplusplus
HAIRLOOM_OFFSET(StrandHeader, random, 12);
HAIRLOOM_OFFSET(StrandHeader, albedo, 16);
HAIRLOOM_OFFSET(StrandHeader, source, 32);
static_assert(sizeof(StrandHeader) == 64);
HAIRLOOM_OFFSET(CurvePoint, tangentXy, 16);
HAIRLOOM_OFFSET(CurvePoint, along, 20);
HAIRLOOM_OFFSET(CurvePoint, strand, 24);
static_assert(sizeof(CurvePoint) == 32);
static_assert(sizeof(StrandPatch) == 16);
static_assert(sizeof(PatchConstants) == 32);
static_assert(sizeof(CurveConstants) == 64);
HAIRLOOM_OFFSET(ViewConstants, eye_ws, 64);
HAIRLOOM_OFFSET(ViewConstants, pixelSize, 80);
HAIRLOOM_OFFSET(ViewConstants, samples, 96);
HAIRLOOM_OFFSET(ViewConstants, layers, 112);
HAIRLOOM_OFFSET(ViewConstants, depthRange, 128);
static_assert(sizeof(ViewConstants) == 144);
HAIRLOOM_OFFSET(LightConstants, toLight_ws, 64);
HAIRLOOM_OFFSET(LightConstants, depthRange, 128);
HAIRLOOM_OFFSET(LightConstants, layers, 144);
static_assert(sizeof(LightConstants) == 208);
static_assert(sizeof(SkyConstants) == 208 * HAIRLOOM_SKY_MAPS);
HAIRLOOM_OFFSET(SkyPoint, halved, 16);
HAIRLOOM_OFFSET(ShadeConstants, primaryExponent, 192);
HAIRLOOM_OFFSET(ShadeConstants, albedo, 240);
HAIRLOOM_OFFSET(ShadeConstants, clumping, 320);
HAIRLOOM_OFFSET(ShadeConstants, count, 352);
HAIRLOOM_OFFSET(ShadeConstants, gridOrigin_ws, 384);
HAIRLOOM_OFFSET(ShadeConstants, lights, 416);
static_assert(sizeof(ShadeConstants) == 416 + 208 * (HAIRLOOM_MAX_LIGHTS + HAIRLOOM_CLOSE_MAPS));
HAIRLOOM_OFFSET(LookConstants, gradientStart, 112);
static_assert(sizeof(LookConstants) == 160);
static_assert(sizeof(MeshConstants) == 80);
HAIRLOOM_OFFSET(RasterConstants, samplePositions, 64);
static_assert(sizeof(RasterConstants) == 128);
static_assert(sizeof(SurfacePixel) == 48);
static_assert(sizeof(TemporalPixel) == 16);
static_assert(sizeof(TemporalConstants) == 32);
HAIRLOOM_OFFSET(SurfaceConstants, firstItem, 160);
static_assert(sizeof(SurfaceConstants) == 176);
static_assert(sizeof(FillConstants) == 16);
static_assert(sizeof(ResolveConstants) == 32);
static_assert(sizeof(PackConstants) == 32);
static_assert(sizeof(ToneConstants) == 16);
static_assert(sizeof(BlurConstants) == 32);
static_assert(sizeof(FilterConstants) == 32);
static_assert(sizeof(OverlayConstants) == 96);
static_assert(sizeof(OverlayVertex) == 32);
static_assert(sizeof(LightCase) == 32);
static_assert(sizeof(LightAnswer) == 48);
static_assert(sizeof(KajiyaCase) == 48);
static_assert(sizeof(FibreConstants) == 96);
static_assert(sizeof(FibreCase) == 112);
}  // namespace hairloom::shaders
#endif
#endif
