// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/shading/strand_look.h"

#include <algorithm>
#include <cmath>

namespace hairloom::shading {
namespace {

constexpr double kDarkest = 0.001;  // as absorptionOfColour() has it
constexpr double kStep = 1e6;       // slope of a ramp without length

Vec3d mix(const Vec3d& a, const Vec3d& b, double t) {
    return a + t * (b - a);
}

Vec3d ofOwnColour(const StrandLook& look, const Vec3d& colour) {
    if (look.quantity == LookQuantity::colour) return colour;
    return (look.ownScale * colour.cwiseMax(kDarkest).cwiseMin(1.0).array().log()).square().matrix();
}

/// Of a strand with so much of the pigment.
Vec3d pigmented(const StrandLook& look, const Vec3d& natural, double pigment) {
    if (look.quantity == LookQuantity::absorption) return pigment * natural;
    return pigment == 1 ? natural : colourOfMoreAbsorption(natural, pigment);
}

}  // namespace

LinearStep LinearStep::between(double start, double end) {
    if (end > start) return {start, 1 / (end - start)};
    return {start - 10 / kStep, kStep};
}

double LinearStep::operator()(double x) const {
    return std::clamp((x - start) * scale, 0.0, 1.0);
}

Vec3d colourOfMoreAbsorption(const Vec3d& colour, double factor) {
    return colour.array().max(0.0).pow(std::sqrt(factor)).matrix();
}

Vec3d lookAt(const StrandLook& look, const StrandPlace& place) {
    const double t = look.gradient(place.along);
    const Vec3d plain = place.ownColour ? ofOwnColour(look, *place.ownColour) : mix(look.root, look.tip, t);
    const Vec3d streak = pigmented(look, mix(look.streakRoot, look.streakTip, t),
                                   1 + look.streakPigment * (place.pigment - 1));
    const Vec3d streaked = mix(pigmented(look, plain, place.pigment), streak, place.streak);
    const double grown = look.regrowth(place.along * place.length);
    const double dye = place.dye * look.dyeAlong(place.along) * grown * grown * (3 - 2 * grown);
    const Vec3d dyed = mix(streaked, look.dye, dye);
    const double factor = 1 + look.spread * (2 * place.random - 1);
    return look.quantity == LookQuantity::absorption ? Vec3d(factor * dyed)
                                                     : colourOfMoreAbsorption(dyed, factor);
}

Vec3d colourAt(const StrandLook& look, const StrandPlace& place) {
    const Vec3d there = lookAt(look, place);
    if (look.quantity == LookQuantity::colour) return there;
    return (-there.array().max(0.0).sqrt() / look.ownScale).exp().matrix();
}

}  // namespace hairloom::shading
