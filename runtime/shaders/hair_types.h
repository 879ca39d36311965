// SPDX-License-Identifier: MIT
// What the kernels that light and shade all hairs share with the program; hairloom/gpu.h has HairLamp for C.
#ifndef HAIRLOOM_HAIR_TYPES_H
#define HAIRLOOM_HAIR_TYPES_H
#include "look_types.h"

// Tables of light in a fibre, floats one after the other:
//   along      [6][HAIR_ALONG], by theta / pi + 1/2. What normalises M of R, TT and TRT by where light
//              comes from, then by where it goes; times a Gaussian of the half angle that is M
//   around     [9][HAIR_INCLINATIONS][HAIR_AROUND][2], by absorption, 2 |theta_d| / pi and phi / pi: N of
//              TT and TRT of a channel
//   reflected  [HAIR_INCLINATIONS][HAIR_AROUND]: N of R
//   averages   [9][2][HAIR_INCLINATIONS][4], by absorption. Shares of light sent on and back, and their
//              variances times them. Their tilts times them, and the share of all plus the first and plus
//              the second moment of the angle by which light is turned
//   spread     [HAIR_WIDTHS][HAIR_SPREAD], by the width of a lobe, HAIR_MIN_SPREAD to HAIR_MAX_SPREAD,
//              and |sin theta|: what normalises it
// Ends of a table are the ends of its coordinate. The nine absorptions are those of absorptionOfLayer() in
// fibre_layers.hlsli.
#define HAIR_ABSORPTIONS 9
#define HAIR_ALONG 64
#define HAIR_AROUND 64
#define HAIR_INCLINATIONS 16
#define HAIR_WIDTHS 24
#define HAIR_SPREAD 32
#define HAIR_TABLE_AROUND (6 * HAIR_ALONG)
#define HAIR_TABLE_REFLECTED (HAIR_TABLE_AROUND + HAIR_ABSORPTIONS * HAIR_INCLINATIONS * HAIR_AROUND * 2)
#define HAIR_TABLE_AVERAGES (HAIR_TABLE_REFLECTED + HAIR_INCLINATIONS * HAIR_AROUND)
#define HAIR_TABLE_SPREAD (HAIR_TABLE_AVERAGES + HAIR_ABSORPTIONS * 2 * HAIR_INCLINATIONS * 4)
#define HAIR_TABLE_FLOATS (HAIR_TABLE_SPREAD + HAIR_WIDTHS * HAIR_SPREAD)
// Radians: one degree and sixty.
#define HAIR_MIN_SPREAD 0.0174532925
#define HAIR_MAX_SPREAD 1.0471975512

// The light's grid: columns of HAIR_SLICES cells along its way, and where hair begins in each.
#define HAIR_COLUMNS 128
#define HAIR_SLICES 32

// HairMaterial::model
#define HAIR_KAJIYA 0
#define HAIR_FIBRE 1

#ifdef __cplusplus
namespace hairloom::shaders {
#endif

// A material of hair.
struct HairMaterial {
    LookConstants look;
    // Kajiya and Kay: strengths of the two highlights, the second times the colour, linear RGB; w: their
    // exponents.
    float4 primary, secondary;
    float primaryTilt;  // tangents of the angles by which they are shifted
    float secondaryTilt;
    float primaryNormalisation;  // one by pi R_O
    float secondaryNormalisation;
    float diffuse;
    float diffuseNormalisation;
    float scattering;    // light that other fibres pass on
    float fibreOpacity;  // how much one fibre takes from the light behind it
    // Marschner: of R, TT and TRT, in radians of the half angle.
    float4 tilts;     // w: 1 by the brightest colour, what a strand's brightness is bounded by
    float4 widths;    // w: random brightness from strand to strand, +-
    float4 scales;    // what M is multiplied with; w: fibres in light's way by those that are counted
    uint model;       // HAIR_KAJIYA, HAIR_FIBRE
    uint table;       // of a fibre: its place among the tables
    uint bounded;     // 1: Kajiya and Kay's hair sends out no more light than it gets
    float axisRatio;  // of an elliptic fibre of Kajiya and Kay
};

// What a hair has of its material's streaks, dye and pigment.
struct HairShade {
    uint material;
    uint number;    // of hl_asset_hairs
    float streak;   // 0 ... 1
    float dye;      // 0 ... 1
    float pigment;  // 0 ... 8, times that of the material; 0 is white
    float length;   // metres, for dye that has grown out
    float own;      // 1 where the hair has a colour of its own
    float unused0;
};

// A lamp far away, and the grid that counts the fibres in its way.
struct HairLamp {
    float4 across, up,
        away;  // rows: a place in the grid of a point (x, y, z, 1), 0 to 1; the third along the light's way
    float4 toLight;  // of unit length; w unused
    float4 light;    // linear, across the light; w: 1 adds to what there is of lamps before, 0 begins
    float4 ground;   // linear albedo of what lies behind the hair as the light sees it; w: square metres of a
                     // column
};

#ifdef __cplusplus
static_assert(sizeof(HairMaterial) == 288 && sizeof(HairShade) == 32 && sizeof(HairLamp) == 96);
static_assert(offsetof(HairMaterial, tilts) == 224 && offsetof(HairMaterial, model) == 272);
}  // namespace hairloom::shaders
#endif
#endif
