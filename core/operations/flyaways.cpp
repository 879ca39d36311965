// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "core/base/smooth_step.h"
#include "core/operations/length_constraint.h"
#include "core/operations/operation.h"
#include "core/operations/strand_frames.h"

namespace hairloom {
namespace {

struct FlyawaysSettings {
    float share = 0.06f;
    float angleDegrees = 35;
    float start = 0.15f;
    float waves = 12;
    float clearance = 0.001f;
    std::uint64_t seed = 1;
};
using S = FlyawaysSettings;

constexpr Field<S> kFields[] = {
    field<&S::share>("share", "", 0, 1, "share of strands that become flyaways"),
    field<&S::angleDegrees>("angleDegrees", "°", 0, 120, "largest angle that tips turn away"),
    field<&S::start>("start", "", 0, 0.99, "share of the length where they leave the others"),
    field<&S::waves>("waves", "1/m", 0, 200, "bends per metre of flyaway hair"),
    clearanceField<&S::clearance>(),
    seedField<&S::seed>("seed", "random seed of the flyaways"),
};
constexpr const char* kFormulaFields[] = {"share", "angleDegrees", "start", "waves"};
std::span<const Field<S>> fieldsOf(const S&) {
    return kFields;
}

Result<std::size_t> flyaways(Groom& groom, const Varied<S>& varied, const Region& region) {
    if (auto status = checkFields("flyaways", varied.base()); !status) return tl::unexpected(status.error());
    const EditOptions options{varied.base().clearance, Turns::asMade, true};
    return editStrands(groom, region, options, [&](StrandEdit& strand) {
        const S settings = varied.at(strand.index);
        Random random = strand.random(settings.seed);
        const std::uint64_t stream = random.next();
        if (random.uniform() >= settings.share) return;
        const float total = strand.totalLength();
        if (!(total > 0)) return;
        const float wildness = random.uniform();
        const float angle = radians(settings.angleDegrees) * wildness * wildness;
        const float around = kPi * random.uniform(-1, 1);
        const float finest = 0.25f * static_cast<float>(strand.lengths.size()) / total;
        const float waves = std::min(settings.waves, finest);
        const auto frames = strandFrames(strand.points, strand.outward());
        Vec3f last = strand.points[0];
        float arc = 0;
        for (std::size_t i = 1; i < strand.points.size(); ++i) {
            arc += strand.lengths[i - 1];
            const float share = smoothStep(settings.start, 1, arc / total);
            const Vec3f segment = strand.points[i] - last;
            last = strand.points[i];
            // More of them rise than sink: those are seen.
            const Vec3f away =
                std::sin(around) * frames[i].lateral + (0.35f + 0.65f * std::cos(around)) * frames[i].outward;
            const Vec3f wander = waveAt(stream, arc * waves);
            const Vec3f direction =
                frames[i].along * std::cos(angle * share) + (away + 0.6f * wander) * std::sin(angle * share);
            const Quatf turn = Quatf::FromTwoVectors(frames[i].along, unitOr(direction, frames[i].along));
            strand.points[i] = strand.points[i - 1] + turn * segment;
        }
        restoreLengthsByDirection(strand.points, strand.lengths);
    });
}

}  // namespace

Operation flyawaysOperation() {
    return variedOperation<S, flyaways, kFormulaFields>("flyaways", 86, "turns single strands into flyaways");
}

}  // namespace hairloom
