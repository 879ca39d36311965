// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/operations/clump.h"

#include <algorithm>
#include <cmath>

#include "core/operations/clump_centres.h"
#include "core/operations/length_constraint.h"
#include "core/operations/operation.h"
#include "core/operations/reshape.h"

namespace hairloom {
namespace {

using S = ClumpSettings;

constexpr Field<S> kFields[] = {
    field<&S::spacing>("spacing", "m", 0.0005, 1,
                       "distance between clump centres: larger gives fewer clumps"),
    field<&S::strength>("strength", "", 0, 1,
                        "how far the tip moves to the clump centre, as a share of the distance"),
    field<&S::profile>("profile", "", 0.1, 10,
                       "how the pull grows from the root: 1 linearly, above 1 nearer to the tip"),
    field<&S::variation>("variation", "", 0, 1, "largest random reduction of the pull per strand"),
    clearanceField<&S::clearance>(),
    seedField<&S::seed>("seed", "random seed of the clump centres"),
};

}  // namespace

std::span<const Field<S>> fieldsOf(const S&) {
    return kFields;
}

Result<std::size_t> clump(Groom& groom, const S& settings, const Region& region) {
    if (auto status = checkFields("clump", settings); !status) return tl::unexpected(status.error());
    const std::vector<std::uint32_t> centres = chooseCentres(groom, settings.spacing, settings.seed);
    const Groom before = groom;
    return editStrands(groom, region, {settings.clearance}, [&](StrandEdit& strand) {
        if (centres[strand.index] == strand.index) return;
        const auto centre = before.strand(centres[strand.index]);
        const float pull =
            settings.strength * (1 - settings.variation * strand.random(settings.seed).uniform());
        for (std::size_t i = 1; i < strand.points.size(); ++i) {
            const float t = static_cast<float>(i) / static_cast<float>(strand.points.size() - 1);
            strand.points[i] +=
                pull * std::pow(t, settings.profile) * (pointAlong(centre, t) - strand.points[i]);
        }
        restoreLengths(strand.points, strand.lengths);
    });
}

Operation clumpOperation() {
    return operation<S, clump>("clump", 30, "pulls strands together into clumps");
}

}  // namespace hairloom
