// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How the hair looks. Plain data; core/shading turns it into scattering parameters.

#include <cstdint>

#include "core/base/math.h"

namespace hairloom {

/// How light scatters in a fibre. All have the controls below that they know.
enum class ShadingModel : std::uint32_t {
    kajiya,     ///< two highlights of a thread (Kajiya and Kay 1989)
    marschner,  ///< a fibre of glass with pigment (Marschner et al. 2003)
    sadeghi,    ///< Marschner's lobes as controls of their own (Sadeghi et al. 2010)
};

/// What the fibres of Marschner and Sadeghi absorb by.
enum class ColourSource : std::uint32_t {
    melanin,  ///< the pigment
    colours,  ///< the colours that Kajiya-Kay shows: the hair is dyed
};

/// How much light fibres of Kajiya-Kay and Sadeghi send out.
enum class EnergyRule : std::uint32_t {
    bounded,    ///< no more than they get
    published,  ///< as much as the published models, which may be more
};

/// How light's way around a fibre of Marschner is found.
enum class AzimuthalSolver : std::uint32_t {
    exact,  ///< by the true angles (thesis, Eq. 40)
    cubic,  ///< by Marschner's cubic (Eq. 42)
};

/// Units, ranges and meanings stand in fieldsOf() (core/groom/file/fields.h).
struct HairMaterial {
    ShadingModel shadingModel = ShadingModel::kajiya;
    float rootRadius = 0.00004f;
    float tipScale = 0.4f;
    Vec3f rootColour = Vec3f(0.16f, 0.08f, 0.04f);
    Vec3f tipColour = Vec3f(0.30f, 0.17f, 0.09f);
    float colourVariation = 0.15f;
    float specular = 0.5f;    ///< c_s
    float shininess = 60.0f;  ///< m
    float eumelanin = 1.3f;
    float pheomelanin = 0.0f;
    float indexOfRefraction = 1.55f;
    float longitudinalRoughness = 0.3f;
    float azimuthalRoughness = 0.3f;
    float scaleTiltDegrees = 2.0f;

    float radiusVariation = 0.0f;
    float gradientStart = 0.0f;
    float gradientEnd = 1.0f;
    float tipMelanin = 1.0f;
    float melaninVariation = 0.0f;
    ColourSource colourSource = ColourSource::melanin;

    // Streaks: strands whose roots lie together and that differ from the others.
    float streakShare = 0.0f;
    float streakWidth = 0.008f;
    float streakSoftness = 0.3f;
    ColourSource streakColourSource = ColourSource::melanin;
    Vec3f streakColour = Vec3f(0.55f, 0.36f, 0.18f);
    float streakMelanin = 0.3f;
    std::uint64_t streakSeed = 1;

    // White strands among the others, by chance.
    float greyShare = 0.0f;
    std::uint64_t greySeed = 1;

    // Dye: where the strand attribute `dye` says how much, or everywhere.
    float dyeStrength = 0.0f;
    Vec3f dyeColour = Vec3f(0.35f, 0.02f, 0.08f);
    float dyeStart = 0.0f;
    float dyeEnd = 0.0f;
    float dyeRegrowth = 0.0f;  ///< metres from the root that have grown since
    float dyeRegrowthSoftness = 0.005f;

    // The highlights one by one, against those that fibres of this roughness and tilt have (thesis, sections
    // 5.2 and 5.3): R is the light's own colour, TT shines through, TRT has the hair's colour. For Marschner
    // and Sadeghi; colours, the azimuthal width and glints for Sadeghi alone.
    float eccentricity = 0.0f;
    float rIntensity = 1.0f, ttIntensity = 1.0f, trtIntensity = 1.0f;
    float rWidth = 1.0f, ttWidth = 1.0f, trtWidth = 1.0f;
    float rShiftDegrees = 0.0f, ttShiftDegrees = 0.0f, trtShiftDegrees = 0.0f;
    Vec3f rColour = Vec3f::Ones(), ttColour = Vec3f::Ones(), trtColour = Vec3f::Ones();
    float ttAzimuthalWidth = 1.0f;
    float glintIntensity = 1.0f;
    float glintWidthDegrees = 10.0f;
    float glintNearDegrees = 30.0f, glintFarDegrees = 45.0f;

    // Where TRT of Marschner's fibres would be infinite, a Gaussian replaces it.
    float causticWidthDegrees = 0.0f;  ///< 0: as the fibre's roughness asks for
    float causticFade = 0.3f;
    float causticIntensity = 1.0f;  ///< k_G
    AzimuthalSolver azimuthalSolver = AzimuthalSolver::exact;

    EnergyRule energy = EnergyRule::bounded;

    bool tubes = false;  ///< no model of hair is used

    float rootOpacity = 1.0f;  ///< changes evenly to tipOpacity
    float tipOpacity = 1.0f;
    float emission = 0.0f;
    Vec3f emissionRootColour = Vec3f(1.0f, 0.6f, 0.2f);
    Vec3f emissionTipColour = Vec3f(0.6f, 0.05f, 0.0f);
};

}  // namespace hairloom
