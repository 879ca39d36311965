// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "core/operations/length_constraint.h"
#include "core/operations/operation.h"
#include "core/operations/strand_frames.h"

namespace hairloom {
namespace {

struct FrizzSettings {
    float angleDegrees = 25;
    float frequency = 120;
    float share = 0.7f;
    float start = 0.02f;
    float clearance = 0.001f;
    std::uint64_t seed = 1;
};
using S = FrizzSettings;

constexpr Field<S> kFields[] = {
    field<&S::angleDegrees>("angleDegrees", "°", 0, 90, "angle of the kinks"),
    field<&S::frequency>("frequency", "1/m", 1, 2000, "kinks per metre of hair, limited to one per segment"),
    field<&S::share>("share", "", 0, 1, "share of strands with frizz. The others do not change"),
    field<&S::start>("start", "m", 0, 5, "distance from the root over which kinks grow to their full angle"),
    clearanceField<&S::clearance>(),
    seedField<&S::seed>("seed", "random seed of the kinks"),
};
constexpr const char* kFormulaFields[] = {"angleDegrees", "frequency", "share", "start"};
std::span<const Field<S>> fieldsOf(const S&) {
    return kFields;
}

/// Turns segments, and keeps the course: kinks lead to and fro about it.
Result<std::size_t> frizz(Groom& groom, const Varied<S>& varied, const Region& region) {
    if (auto status = checkFields("frizz", varied.base()); !status) return tl::unexpected(status.error());
    return editStrands(groom, region, {varied.base().clearance, Turns::asMade}, [&](StrandEdit& strand) {
        const S settings = varied.at(strand.index);
        const float sine = std::sin(radians(settings.angleDegrees));
        Random random = strand.random(settings.seed);
        const std::uint64_t stream = random.next();
        if (random.uniform() >= settings.share) return;
        const float own = 0.4f + 0.6f * random.uniform();  // no two strands are equally frizzy
        Vec3f last = strand.points[0];
        float arc = 0;
        for (std::size_t i = 1; i < strand.points.size(); ++i) {
            const Vec3f segment = strand.points[i] - last;
            last = strand.points[i];
            arc += strand.lengths[i - 1];
            const float grown = settings.start > 0 ? std::min(arc / settings.start, 1.0f) : 1.0f;
            const Vec3f direction = unitOr(segment, Vec3f::Zero());
            const Vec3f kink = waveAt(stream, arc * settings.frequency);
            const Vec3f aside = kink - direction * kink.dot(direction);
            strand.points[i] =
                strand.points[i - 1] +
                unitOr(direction + sine * own * grown * aside, direction) * strand.lengths[i - 1];
        }
    });
}

}  // namespace

Operation frizzOperation() {
    return variedOperation<S, frizz, kFormulaFields>(
        "frizz", 42, "adds random kinks to strands, to some more than to others");
}

}  // namespace hairloom
