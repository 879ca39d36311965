// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/operations/set_length.h"

#include <algorithm>

#include "core/operations/head_places.h"
#include "core/operations/operation.h"
#include "core/operations/reshape.h"

namespace hairloom {
namespace {

using S = SetLengthSettings;

constexpr Field<S> kFields[] = {
    field<&S::length>("length", "m", 0.001, 5, "strand length before variation and gradient"),
    field<&S::variation>("variation", "", 0, 1, "shortens each strand by a random share up to this"),
    boolField<&S::rescale>("rescale", "true scales the shape; false cuts strands or extends them straight"),
    field<&S::gradientPoint>("gradientPoint", "m", -kAnywhere, kAnywhere,
                             "where the gradient begins. Zero is the top of the head"),
    field<&S::gradientAxis>("gradientAxis", "", -kAnywhere, kAnywhere, "direction of the gradient"),
    field<&S::gradientDistance>("gradientDistance", "m", 0, kAnywhere,
                                "distance along the axis to the end of the gradient: 0 is no gradient"),
    field<&S::farScale>("farScale", "", 0.01, 100,
                        "ratio of the length at the end of the gradient to the length at its start"),
    clearanceField<&S::clearance>(),
    seedField<&S::seed>("seed", "random seed of the variation"),
};
constexpr const char* kFormulaFields[] = {"length", "variation"};

float gradientAt(const S& settings, const Vec3f& root) {
    if (settings.gradientDistance <= 0 || settings.gradientAxis.isZero(0.0f)) return 1;
    const float along = (root - settings.gradientPoint).dot(settings.gradientAxis.normalized());
    return 1 + (settings.farScale - 1) * std::clamp(along / settings.gradientDistance, 0.0f, 1.0f);
}

constexpr float kShortest = 0.001f;  ///< metres; strands are never made shorter

}  // namespace

std::span<const Field<S>> fieldsOf(const S&) {
    return kFields;
}

namespace {

Result<std::size_t> setLengthVaried(Groom& groom, const Varied<S>& varied, const Region& region) {
    if (auto status = checkFields("set_length", varied.base()); !status)
        return tl::unexpected(status.error());
    const S& asked = varied.base();
    const Vec3f begin = asked.gradientPoint.isZero(0) ? topOfHead(groom) : asked.gradientPoint;
    return editStrands(groom, region, {asked.clearance, Turns::asMade}, [&](StrandEdit& strand) {
        S settings = varied.at(strand.index);
        settings.gradientPoint = begin;
        const float share = 1 - settings.variation * strand.random(settings.seed).uniform();
        const float length =
            std::max(kShortest, settings.length * share * gradientAt(settings, strand.points[0]));
        if (settings.rescale) {
            scaleToLength(strand.points, length);
        } else {
            cutOrExtend(strand.points, length);
        }
    });
}

}  // namespace

Result<std::size_t> setLength(Groom& groom, const S& settings, const Region& region) {
    return setLengthVaried(groom, settings, region);
}

Operation setLengthOperation() {
    return variedOperation<S, setLengthVaried, kFormulaFields>("set_length", 10,
                                                               "sets the length of strands");
}

}  // namespace hairloom
