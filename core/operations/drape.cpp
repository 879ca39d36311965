// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/operations/drape.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/curve.h"
#include "core/operations/operation.h"

namespace hairloom {
namespace {

using S = DrapeSettings;

constexpr Field<S> kFields[] = {
    field<&S::amount>("amount", "", 0, 1, "how far the tip turns straight down, as a share"),
    field<&S::rootAmount>("rootAmount", "", 0, 1, "the same at the root. It changes linearly in between"),
    clearanceField<&S::clearance>(),
};
constexpr const char* kFormulaFields[] = {"amount", "rootAmount"};

/// Turns a unit vector by a share of its angle to straight down.
Vec3f turnDown(const Vec3f& direction, float share) {
    const Quatf whole = shortestArc(direction, -Vec3f::UnitY());
    return (Quatf::Identity().slerp(share, whole) * direction).normalized();
}

}  // namespace

std::span<const Field<S>> fieldsOf(const S&) {
    return kFields;
}

namespace {

Result<std::size_t> drapeVaried(Groom& groom, const Varied<S>& varied, const Region& region) {
    if (auto status = checkFields("drape", varied.base()); !status) return tl::unexpected(status.error());
    return editStrands(groom, region, {varied.base().clearance}, [&](StrandEdit& strand) {
        const S settings = varied.at(strand.index);
        const std::size_t segments = strand.lengths.size();
        Vec3f before = strand.points[0];
        float last = settings.rootAmount;
        for (std::size_t i = 1; i <= segments; ++i) {
            const float t = static_cast<float>(i) / static_cast<float>(segments);
            const float share = settings.rootAmount + t * (settings.amount - settings.rootAmount);
            const Vec3f along = strand.points[i] - before;
            before = strand.points[i];
            if (!(along.norm() > 0)) continue;
            // What the shares ask for; hair that points up nearly would else go down on any side.
            const float asked =
                (share - last) * std::acos(std::clamp(-along.y() / along.norm(), -1.0f, 1.0f));
            const float had = std::acos(std::clamp(strand.turns[i - 1], -1.0f, 1.0f));
            strand.turns[i - 1] = std::cos(std::min(had + std::abs(asked), kPi));
            last = share;
            const Vec3f turned = turnDown(along.normalized(), share);
            strand.points[i] = strand.points[i - 1] + turned * strand.lengths[i - 1];
        }
    });
}

}  // namespace

Result<std::size_t> drape(Groom& groom, const S& settings, const Region& region) {
    return drapeVaried(groom, settings, region);
}

Operation drapeOperation() {
    return variedOperation<S, drapeVaried, kFormulaFields>("drape", 70,
                                                           "bends strands downwards, as gravity does");
}

}  // namespace hairloom
