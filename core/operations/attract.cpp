// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <cmath>

#include "core/base/smooth_step.h"
#include "core/operations/length_constraint.h"
#include "core/operations/operation.h"
#include "core/operations/strand_frames.h"

namespace hairloom {
namespace {

enum class AttractTo : std::uint32_t { nearest, along };

struct AttractSettings {
    AttractTo to = AttractTo::nearest;
    float strength = 0.7f;
    float profile = 1;
    float reach = 0.15f;
    float spread = 0.004f;
    float clearance = 0.001f;
    std::uint64_t seed = 1;
    DrawnCurve curve;
};
using S = AttractSettings;

constexpr std::array<const char*, 2> kTo = {"nearest", "along"};
constexpr Field<S> kFields[] = {
    choiceField<&S::to>(
        "to", "target on the curve: nearest point, or the point at the same share of the length", kTo),
    field<&S::strength>("strength", "", 0, 1,
                        "how far the tip moves to the curve, as a share of the distance"),
    field<&S::profile>("profile", "", 0.1, 10,
                       "how the pull grows from the root: 1 linearly, above 1 nearer to the tip"),
    field<&S::reach>("reach", "m", 0, kAnywhere,
                     "largest distance of a root from the curve: 0 affects all strands"),
    field<&S::spread>("spread", "m", 0, 0.5, "radius around the curve in which strands end up"),
    clearanceField<&S::clearance>(),
    seedField<&S::seed>("seed", "random seed of the positions around the curve"),
};
constexpr const char* kFormulaFields[] = {"strength", "profile", "spread", "reach"};
std::span<const Field<S>> fieldsOf(const S&) {
    return kFields;
}

Result<std::size_t> attract(Groom& groom, const Varied<S>& varied, const Region& region) {
    if (auto status = checkFields("attract", varied.base()); !status) return tl::unexpected(status.error());
    if (!CurveLine::isDrawn(varied.base().curve)) return std::size_t{0};
    const CurveLine line(varied.base().curve);
    return editStrands(groom, region, {varied.base().clearance}, [&](StrandEdit& strand) {
        const S settings = varied.at(strand.index);
        const float away = line.nearest(strand.points[0]).distance;
        const float reached =
            settings.reach > 0 ? 1 - smoothStep(0.5f * settings.reach, settings.reach, away) : 1.0f;
        if (!(reached > 0)) return;
        Random random = strand.random(settings.seed);
        const float angle = kPi * random.uniform(-1, 1);
        const float radius = settings.spread * std::sqrt(random.uniform());
        const float total = strand.totalLength();
        float arc = 0;
        for (std::size_t i = 1; i < strand.points.size(); ++i) {
            arc += strand.lengths[i - 1];
            const float share = total > 0 ? arc / total : 1.0f;
            const float place =
                settings.to == AttractTo::along ? share * line.length() : line.nearest(strand.points[i]).arc;
            const Vec3f direction = line.directionAt(place);
            const Vec3f side = unitOr(direction.cross(Vec3f::UnitY()), direction.unitOrthogonal());
            const Vec3f target =
                line.at(place) + radius * (std::cos(angle) * side + std::sin(angle) * side.cross(direction));
            strand.points[i] +=
                settings.strength * reached * std::pow(share, settings.profile) * (target - strand.points[i]);
        }
        restoreLengths(strand.points, strand.lengths);
    });
}

}  // namespace

Operation attractOperation() {
    return variedOperation<S, attract, kFormulaFields>("attract", 24, "pulls strands towards a curve");
}

}  // namespace hairloom
