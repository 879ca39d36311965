// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/operations/dye.h"

#include <algorithm>

#include "core/groom/point_dye.h"
#include "core/operations/operation.h"

namespace hairloom {
namespace {

using S = DyeSettings;

constexpr Field<S> kFields[] = {
    field<&S::amount>("amount", "", 0, 1, "value that the mask is set to: 1 is full dye"),
    field<&S::centre>("centre", "m", -kAnywhere, kAnywhere, "centre of the sphere that selects roots"),
    field<&S::radius>("radius", "m", 0, kAnywhere, "radius of that sphere: 0 affects all roots"),
    field<&S::softness>("softness", "m", 0, 1,
                        "distance over which the effect fades at the edge of the sphere"),
    field<&S::variation>("variation", "", 0, 1, "largest random reduction of the dye per strand"),
    seedField<&S::seed>("seed", "random seed of the variation"),
};

/// 0 outside of the ball … 1 well inside.
float reachOf(const S& settings, const Vec3f& root_ss) {
    if (settings.radius <= 0) return 1;
    const float inside = settings.radius - (root_ss - settings.centre).norm();
    return settings.softness > 0 ? std::clamp(inside / settings.softness, 0.0f, 1.0f)
                                 : (inside >= 0 ? 1.0f : 0.0f);
}

}  // namespace

std::span<const Field<S>> fieldsOf(const S&) {
    return kFields;
}

Result<std::size_t> dye(Groom& groom, const S& settings, const Region& region) {
    if (auto status = checkFields("dye", settings); !status) return tl::unexpected(status.error());
    const bool byPoints = groom.pointAttributes.has(attribute::kPointDye);
    const auto before = byPoints ? groom.pointAttributes.view<float>(attribute::kPointDye)
                                 : groom.strandAttributes.view<float>(attribute::kDye);
    std::vector<float> mask(before.begin(), before.end());
    mask.resize(byPoints ? groom.pointCount() : groom.strandCount(), 0.0f);
    std::vector<float> old = mask;
    const auto valuesOf = [&groom, byPoints](std::vector<float>& values, std::size_t strand) {
        const std::size_t first = byPoints ? groom.offsets[strand] : strand;
        return std::span(values).subspan(first, byPoints ? groom.offsets[strand + 1] - first : 1);
    };
    // The loop keeps frozen strands and those of locked layers out; no point moves.
    const auto reached = editStrands(groom, region, {}, [&](StrandEdit& strand) {
        const float reach = reachOf(settings, strand.points[0]);
        const float amount =
            settings.amount * (1 - settings.variation * strand.random(settings.seed).uniform());
        for (float& value : valuesOf(mask, strand.index)) value += reach * (amount - value);
    });
    static_cast<void>(reached);
    std::size_t changed = 0;
    for (std::size_t s = 0; s < groom.strandCount(); ++s)
        changed += std::ranges::equal(valuesOf(mask, s), valuesOf(old, s)) ? 0 : 1;
    if (changed == 0) return changed;
    if (byPoints) {
        groom.pointAttributes.set(attribute::kPointDye, std::move(mask));
    } else {
        groom.strandAttributes.set(attribute::kDye, std::move(mask));
    }
    return changed;
}

Operation dyeOperation() {
    return lastingOperation<S, dye>("dye", 100, "sets the dye mask of strands");
}

}  // namespace hairloom
