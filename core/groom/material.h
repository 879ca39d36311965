// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How the hair looks. Plain data; core/shading turns it into scattering parameters.

#include <cstdint>

#include "core/base/math.h"

namespace hairloom {

struct HairMaterial {
    float rootRadius =
        0.00004f;  ///< metres, 5e-6 … 0.005; half the fibre's diameter at the root (a hair: 25–60 µm)
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

    // What an artist turns beside the fibre itself (thesis, Figure 33).
    std::uint32_t shadingModel = 0;  ///< 0 Kajiya-Kay, 1 Marschner, 2 Sadeghi: the one that the editor shows
    float diffuse = 0.55f;           ///< 0 … 1; Kajiya-Kay c_d
    float secondSpecular = 1.0f;     ///< 0 … 4; factor on the second, coloured highlight of Kajiya-Kay
    float scattering = 0.55f;        ///< 0 … 1; light that other fibres pass on, Kajiya-Kay
    float eccentricity = 0.0f;       ///< 0 … 0.95; numerical, of the fibre's cross-section
    // Of the lobes R, TT and TRT, in Marschner's and Sadeghi's model; what the fibre gives is factor 1 and
    // shift 0.
    float rIntensity = 1.0f, ttIntensity = 1.0f, trtIntensity = 1.0f;  ///< 0 … 4, factors
    float rWidth = 1.0f, ttWidth = 1.0f, trtWidth = 1.0f;              ///< 0.2 … 4, factors along the fibre
    float rShift = 0.0f, ttShift = 0.0f, trtShift = 0.0f;  ///< −15 … 15 degrees towards the tip, added
    float glintIntensity = 1.0f;                           ///< 0 … 4; factor on the glints of TRT
    float glintWidth = 1.0f;                               ///< 0.2 … 4; factor
    float causticFade = 0.3f;        ///< 0.01 … 1; Marschner: how softly caustics end (Δη')
    float ttSpread = 1.0f;           ///< 0.2 … 4; Sadeghi: factor on the width of TT around the fibre
    float glintNearDegrees = 30.0f;  ///< 0 … 90; Sadeghi: where the glints of strands begin
    float glintFarDegrees = 45.0f;   ///< 0 … 90; and end
    Vec3f rTint = Vec3f::Ones();     ///< linear RGB, 0 … 1; Sadeghi: factor on the colour of a lobe
    Vec3f ttTint = Vec3f::Ones();
    Vec3f trtTint = Vec3f::Ones();
};

}  // namespace hairloom
