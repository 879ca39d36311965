// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "core/operations/length_constraint.h"
#include "core/operations/operation.h"
#include "core/operations/strand_frames.h"

namespace hairloom {
namespace {

struct ShrinkwrapSettings {
    float strength = 0.8f;
    float distance = 0.004f;
    float reach = 0.06f;
    float variation = 0.5f;
    float clearance = 0.001f;
    std::uint64_t seed = 1;
};
using S = ShrinkwrapSettings;

constexpr Field<S> kFields[] = {
    field<&S::strength>("strength", "", 0, 1, "share of the way to the skin"),
    field<&S::distance>("distance", "m", 0, 0.1, "height over the skin that hair is drawn to"),
    field<&S::reach>("reach", "m", 0.001, 1, "height over the skin from which hair is not drawn at all"),
    field<&S::variation>("variation", "", 0, 1, "random share by which the height of a strand may be lower"),
    clearanceField<&S::clearance>(),
    seedField<&S::seed>("seed", "another seed varies the strands differently"),
};
std::span<const Field<S>> fieldsOf(const S&) {
    return kFields;
}

Result<std::size_t> shrinkwrap(Groom& groom, const S& settings, const Region& region) {
    if (auto status = checkFields("shrinkwrap", settings); !status) return tl::unexpected(status.error());
    if (!groom.scalp) return fail("shrinkwrap: the groom has no scalp", "bind it to one first");
    return editStrands(groom, region, {settings.clearance, true}, [&](StrandEdit& strand) {
        const float height =
            settings.distance * (1 - settings.variation * strand.random(settings.seed).uniform());
        float arc = 0;
        for (std::size_t i = 1; i < strand.points.size(); ++i) {
            arc += strand.lengths[i - 1];
            const SkinDistance skin = strand.skin->distanceAt(strand.points[i]);
            const float fade = 1 - smoothStep(0.5f * settings.reach, settings.reach, skin.distance);
            const float wanted = std::min(height, 0.5f * arc);
            strand.points[i] += settings.strength * fade * (wanted - skin.distance) * skin.outward;
        }
        restoreLengths(strand.points, strand.lengths);
    });
}

}  // namespace

Operation shrinkwrapOperation() {
    return operation<S, shrinkwrap>("shrinkwrap", 26, "draws strands to the skin of the head");
}

}  // namespace hairloom
