// SPDX-License-Identifier: MIT
#include "hairloom/presets.h"

#include <algorithm>
#include <cmath>

namespace hairloom::runtime {
namespace {

/// Rünz 2012, Table 1, in its order.
constexpr HairPreset kPresets[] = {
    {"ethiopian",
     "coarse, of strongly elliptical cross-section",
     90.62e-6,
     0.82,
     "wavy to woolly",
     "brown-black to black",
     {0.010f, 0.008f, 0.007f},
     {0.016f, 0.012f, 0.010f},
     7.0f},
    {"caucasian",
     "fine, of elliptical cross-section",
     63.93e-6,
     0.67,
     "straight to curly",
     "blond to dark brown",
     {0.16f, 0.08f, 0.04f},
     {0.30f, 0.17f, 0.09f},
     1.3f},
    {"mongolian",
     "of medium thickness and nearly circular cross-section",
     79.53e-6,
     0.60,
     "straight to wavy",
     "dark brown to brown-black",
     {0.020f, 0.012f, 0.008f},
     {0.035f, 0.022f, 0.014f},
     4.0f},
};

}  // namespace

std::span<const HairPreset> presets() {
    return kPresets;
}

const HairPreset* findPreset(std::string_view name) {
    const auto found = std::find_if(std::begin(kPresets), std::end(kPresets),
                                    [&](const HairPreset& p) { return p.name == name; });
    return found != std::end(kPresets) ? found : nullptr;
}

double bendingStiffness(double diameter, double eccentricity) {
    return kYoungsModulus * diameter * diameter * (1.0 - eccentricity * eccentricity) / (16.0 * kHairDensity);
}

double bendingStiffnessOf(double angularStiffness) {
    return kHairBendingStiffness * angularStiffness / std::max(1.0 - angularStiffness, 1e-9);
}

float angularStiffnessOf(double bendingStiffness) {
    return static_cast<float>(bendingStiffness / (bendingStiffness + kHairBendingStiffness));
}

void applyPreset(const HairPreset& preset, SimulationSettings& settings) {
    const double ratio = std::sqrt(1.0 - preset.eccentricity * preset.eccentricity);
    settings.sectionRatio = static_cast<float>(ratio);
    // Of a flat rod, B is the mean of both axes: the weak one has ρB.
    settings.angularStiffness =
        angularStiffnessOf(bendingStiffness(preset.diameter, preset.eccentricity) / ratio);
    settings.angularCurve = Ramp();
}

}  // namespace hairloom::runtime
