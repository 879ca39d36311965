// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/operations/trim.h"

#include <algorithm>
#include <limits>

#include "core/operations/head_places.h"
#include "core/operations/operation.h"
#include "core/operations/reshape.h"

namespace hairloom {
namespace {

using S = TrimSettings;

constexpr Field<S> kFields[] = {
    field<&S::planePoint>("planePoint", "m", -kAnywhere, kAnywhere,
                          "a point on the cutting plane. Zero is the top of the head"),
    field<&S::planeNormal>("planeNormal", "", -kAnywhere, kAnywhere,
                           "normal that points to the side to cut off. Zero uses no plane"),
    field<&S::maxLength>("maxLength", "m", 0.001, 5, "cuts strands to this length"),
    field<&S::raggedness>("raggedness", "m", 0, 1,
                          "cuts each strand shorter by a random length up to this: 0 is blunt"),
    field<&S::minLength>("minLength", "m", 0.001, 1, "minimum length that remains"),
    seedField<&S::seed>("seed", "random seed of the ragged ends"),
};
constexpr const char* kFormulaFields[] = {"maxLength", "raggedness", "minLength"};

/// Arc length at which the strand first crosses the plane; infinite when it does not.
float lengthToPlane(const StrandEdit& strand, const S& settings) {
    constexpr float kNever = std::numeric_limits<float>::infinity();
    if (settings.planeNormal.isZero(0.0f)) return kNever;
    const Vec3f normal = settings.planeNormal.normalized();
    const auto beyond = [&](std::size_t i) { return (strand.points[i] - settings.planePoint).dot(normal); };
    if (beyond(0) > 0) return 0;
    float length = 0;
    for (std::size_t i = 1; i < strand.points.size(); ++i) {
        const float from = beyond(i - 1);
        const float to = beyond(i);
        if (to > 0) return length + strand.lengths[i - 1] * (-from / (to - from));
        length += strand.lengths[i - 1];
    }
    return kNever;
}

}  // namespace

std::span<const Field<S>> fieldsOf(const S&) {
    return kFields;
}

namespace {

Result<std::size_t> trimVaried(Groom& groom, const Varied<S>& varied, const Region& region) {
    if (auto status = checkFields("trim", varied.base()); !status) return tl::unexpected(status.error());
    const S& asked = varied.base();
    const Vec3f point = asked.planePoint.isZero(0) ? topOfHead(groom) : asked.planePoint;
    return editStrands(groom, region, {.turns = Turns::asMade}, [&](StrandEdit& strand) {
        S settings = varied.at(strand.index);
        settings.planePoint = point;
        const float now = strand.totalLength();
        const float ragged = settings.raggedness * strand.random(settings.seed).uniform();
        const float cut = std::min(lengthToPlane(strand, settings), settings.maxLength);
        if (cut >= now) return;
        const float length = std::max(settings.minLength, cut - ragged);
        if (length < now) cutOrExtend(strand.points, length);
    });
}

}  // namespace

Result<std::size_t> trim(Groom& groom, const S& settings, const Region& region) {
    return trimVaried(groom, settings, region);
}

Operation trimOperation() {
    return variedOperation<S, trimVaried, kFormulaFields>(
        "trim", 80, "cuts strands by a plane or to a length, blunt or ragged");
}

}  // namespace hairloom
