// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What hair looks like from place to place: gradients along a strand, streaks, dye, and chance. In double
// precision, the reference of shaders/look.hlsli. The same rule mixes colours (linear RGB, for Kajiya-Kay)
// and absorption (RGB per fibre radius, for light in fibres): pigments in one fibre add up, so absorption is
// what mixes evenly there.

#include "core/base/math.h"

namespace hairloom::shading {

/// 0 up to a place, then rising evenly to 1.
struct LinearStep {
    double start = 0;
    double scale = 1;  ///< one by the way from 0 to 1

    /// `end` <= `start`: a step that is 1 at `start` already.
    static LinearStep between(double start, double end);
    double operator()(double x) const;
    bool operator==(const LinearStep&) const = default;
};

enum class LookQuantity { colour, absorption };

struct StrandLook {
    LookQuantity quantity = LookQuantity::colour;
    Vec3d root = Vec3d::Zero(), tip = Vec3d::Zero();
    LinearStep gradient;  ///< from root to tip, by the share of the length
    Vec3d streakRoot = Vec3d::Zero(), streakTip = Vec3d::Zero();
    Vec3d dye = Vec3d::Zero();
    LinearStep dyeAlong;
    /// By metres from the root: what has grown since the dye has none. Smooth, by 3 t² − 2 t³.
    LinearStep regrowth{-1, 1e6};
    double streakPigment = 0;  ///< 1: streaks are bleached, and their pigment goes with the strand's; 0: dyed
    double spread = 0;         ///< 0…1, random, of absorption
    /// Absorption of a strand's own colour c is (ownScale ln c)² (Chiang et al. 2016, as
    /// absorptionOfColour()).
    double ownScale = 0;
    Vec3d emissionRoot = Vec3d::Zero(), emissionTip = Vec3d::Zero();  ///< linear RGB radiance

    bool operator==(const StrandLook&) const = default;
};

/// A point of a strand.
struct StrandPlace {
    double along = 0;                  ///< 0 root … 1 tip
    double random = 0;                 ///< 0…1, the strand's
    double streak = 0;                 ///< 0…1, how much the strand is in a streak
    double dye = 0;                    ///< 0…1
    double pigment = 1;                ///< 0…8, the strand's, times that of the look; 0 is white
    double length = 0;                 ///< metres, the strand's
    const Vec3d* ownColour = nullptr;  ///< in place of root and tip; linear RGB
};

/// Colour or absorption there.
Vec3d lookAt(const StrandLook& look, const StrandPlace& place);

/// The colour that much such hair has there, linear RGB.
Vec3d colourAt(const StrandLook& look, const StrandPlace& place);

/// What a factor on the absorption makes of a colour: ln c goes with its root (Chiang et al. 2016).
Vec3d colourOfMoreAbsorption(const Vec3d& colour, double factor);

}  // namespace hairloom::shading
