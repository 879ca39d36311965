// SPDX-License-Identifier: MIT
#pragma once
// Measured hair: the three groups of Rünz 2012, Table 1 (after Robbins 2002 and Sobottka and Weber 2003), and
// the stiffness that follows from them. A preset says what a fibre is made of; what curl its strands have is
// authored as their shape.

#include <span>
#include <string_view>

#include "hairloom/settings.h"

namespace hairloom::runtime {

/// Averages of a group of people.
struct HairPreset {
    const char* name;         ///< as Table 1 names the group, in lower case
    const char* description;  ///< of the fibre
    double diameter;          ///< metres, along the long principal axis of the elliptical cross-section
    double eccentricity;      ///< √(1 − b²/a²) of the semi-axes a ≥ b, 0…1
    const char* curl;         ///< the range of Table 1
    const char* colour;       ///< the range of Table 1
    // The table has words only for colours; these numbers are picked to show the middle of its range.
    Float3 rootColour, tipColour;  ///< linear RGB, 0…1
    float eumelanin;               ///< concentration as in Chiang et al. 2016: 0.3 blond, 1.3 brown, 8 black
};

std::span<const HairPreset> presets();
/// The preset of that name, or null.
const HairPreset* findPreset(std::string_view name);

/// EI/(ρA) in m⁴/s² of an elliptical fibre, `diameter` along the long axis in metres. For bending about the
/// long axis I = π a b³/4 and A = π a b, hence I/A = b²/4 = d²(1 − e²)/16. This is the weak direction: a
/// fibre that is free to twist turns its thin side into the bend.
double bendingStiffness(double diameter, double eccentricity);

/// The angularStiffness s that stands for B ≥ 0, in m⁴/s²: B = kHairBendingStiffness · s/(1 − s).
float angularStiffnessOf(double bendingStiffness);

/// And the other way: the B that s, 0…1, stands for. Rigid hair counts as s = 1 − 10⁻⁹.
double bendingStiffnessOf(double angularStiffness);

/// Sets sectionRatio to b/a, angularStiffness such that the weak direction has bendingStiffness(), and
/// angularCurve to 1 everywhere: fibres are as thick at the tip. All else stays. Springs have one stiffness
/// for all directions and take the mean of the two.
void applyPreset(const HairPreset& preset, SimulationSettings& settings);

}  // namespace hairloom::runtime
