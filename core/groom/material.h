// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How the hair looks. Plain data; core/shading turns it into scattering parameters.

#include <cstdint>

#include "core/base/math.h"

namespace hairloom {

struct HairMaterial {
    float rootRadius =
        0.00004f;  ///< metres, 5e-6 … 0.05; half the fibre's diameter at the root (a hair: 25–60 µm)
    float tipScale = 0.4f;                          ///< 0 … 1; radius at the tip over radius at the root
    Vec3f rootColour = Vec3f(0.16f, 0.08f, 0.04f);  ///< linear RGB, 0 … 1
    Vec3f tipColour = Vec3f(0.30f, 0.17f, 0.09f);   ///< linear RGB, 0 … 1
    float colourVariation = 0.15f;    ///< 0 … 1; random spread of brightness from strand to strand
    float specular = 0.5f;            ///< 0 … 2; weight of the highlight (Kajiya-Kay c_s)
    float shininess = 60.0f;          ///< 1 … 1000; Kajiya-Kay exponent m, higher is a narrower highlight
    float eumelanin = 1.3f;           ///< 0 … 8; concentration, brown to black
    float pheomelanin = 0.0f;         ///< 0 … 8; concentration, red to blond
    float indexOfRefraction = 1.55f;  ///< 1 … 2.5
    float longitudinalRoughness = 0.3f;  ///< 0.01 … 1
    float azimuthalRoughness = 0.3f;     ///< 0.01 … 1
    float scaleTiltDegrees = 2.0f;       ///< −10 … 10 degrees towards the root

    float radiusVariation = 0.0f;   ///< 0 … 1; random spread of the radius from strand to strand
    float gradientStart = 0.0f;     ///< 0 … 1 of the length; where the root's colour and melanin end
    float gradientEnd = 1.0f;       ///< 0 … 1; where the tip's begin
    float tipMelanin = 1.0f;        ///< 0 … 8; both pigments at the tip over those at the root
    float melaninVariation = 0.0f;  ///< 0 … 1; random spread of what strands absorb
    bool dyed = false;  ///< light in fibres is absorbed as the colours say, not as the melanin does

    // Streaks: strands whose roots lie together and that differ from the others.
    float streakShare = 0.0f;     ///< 0 … 1 of the strands; 0: none
    float streakWidth = 0.008f;   ///< metres on the scalp, 0.0005 … 0.2
    float streakSoftness = 0.3f;  ///< 0 … 1; 0: a strand is in a streak or not
    bool streakDyed = false;      ///< the streaks have their colour; else they differ in melanin
    Vec3f streakColour = Vec3f(0.55f, 0.36f, 0.18f);  ///< linear RGB, 0 … 1
    float streakMelanin = 0.3f;                       ///< 0 … 8; melanin in streaks over that beside them
    std::uint64_t streakSeed = 1;                     ///< other places

    // Dye: where the strand attribute `dye` says how much, or everywhere.
    float dyeStrength = 0.0f;                      ///< 0 … 1; 0: none
    Vec3f dyeColour = Vec3f(0.35f, 0.02f, 0.08f);  ///< linear RGB, 0 … 1
    float dyeStart = 0.0f;                         ///< 0 … 1 of the length; where dye begins
    float dyeEnd = 0.0f;                           ///< 0 … 1; where it has its full strength

    // The highlights one by one, against those that fibres of this roughness and tilt have (thesis, sections
    // 5.2 and 5.3): R is the light's own colour, TT shines through, TRT has the hair's colour. For Marschner
    // and Sadeghi; colours, the azimuthal width and glints for Sadeghi alone.
    float eccentricity = 0.0f;  ///< 0 … 0.95 of the cross-section; Marschner
    float rIntensity = 1.0f, ttIntensity = 1.0f, trtIntensity = 1.0f;  ///< 0 … 10, factors
    float rWidth = 1.0f, ttWidth = 1.0f, trtWidth = 1.0f;  ///< 0.1 … 10, factors, along the hair
    float rShiftDegrees = 0.0f, ttShiftDegrees = 0.0f, trtShiftDegrees = 0.0f;  ///< −30 … 30, added
    Vec3f rColour = Vec3f::Ones(), ttColour = Vec3f::Ones(), trtColour = Vec3f::Ones();  ///< linear, 0 … 1
    float ttAzimuthalWidth = 1.0f;                            ///< 0.1 … 10, factor
    float glintIntensity = 1.0f;                              ///< 0 … 20, factor
    float glintWidthDegrees = 10.0f;                          ///< 1 … 90, around the hair
    float glintNearDegrees = 30.0f, glintFarDegrees = 45.0f;  ///< 0 … 180; each strand's glint lies between

    bool tubes = false;  ///< strands are round and have skin: tentacles; no model of hair is used

    float rootOpacity = 1.0f;  ///< 0 … 1 at the root; changes evenly
    float tipOpacity = 1.0f;   ///< 0 … 1 at the tip
    float emission = 0.0f;     ///< 0 … 1000; light that strands give off by themselves, 0: none
    Vec3f emissionRootColour = Vec3f(1.0f, 0.6f, 0.2f);  ///< linear RGB, 0 … 1
    Vec3f emissionTipColour = Vec3f(0.6f, 0.05f, 0.0f);  ///< linear RGB, 0 … 1
};

}  // namespace hairloom
