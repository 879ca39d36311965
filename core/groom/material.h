// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How the hair looks. Plain data; core/shading turns it into scattering parameters.

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
};

}  // namespace hairloom
