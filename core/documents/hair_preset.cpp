// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/documents/hair_preset.h"

namespace hairloom {
namespace {

Vec3f colourOf(runtime::Float3 colour) {
    return {colour.x, colour.y, colour.z};
}

}  // namespace

std::size_t applyPreset(const runtime::HairPreset& preset, Groom& groom) {
    runtime::applyPreset(preset, groom.simulation);
    groom.material.eccentricity = static_cast<float>(preset.eccentricity);
    groom.material.rootRadius = static_cast<float>(0.5 * preset.diameter);
    groom.material.rootColour = colourOf(preset.rootColour);
    groom.material.tipColour = colourOf(preset.tipColour);
    groom.material.eumelanin = preset.eumelanin;
    groom.material.pheomelanin = 0.0f;
    return 9;
}

}  // namespace hairloom
