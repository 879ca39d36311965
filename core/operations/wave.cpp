// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "core/operations/length_constraint.h"
#include "core/operations/operation.h"
#include "core/operations/strand_frames.h"

namespace hairloom {
namespace {

struct WaveSettings {
    float amplitude = 0.008f;
    float frequency = 18;
    float start = 0.04f;
    float turnDegrees = 0;
    float phaseVariation = 0.15f;
    float amplitudeVariation = 0.3f;
    float clearance = 0.001f;
    std::uint64_t seed = 1;
};
using S = WaveSettings;

constexpr Field<S> kFields[] = {
    field<&S::amplitude>("amplitude", "m", 0, 0.1, "amplitude of the waves"),
    field<&S::frequency>("frequency", "1/m", 0, 500,
                         "waves per metre of hair, limited to one wave per four segments"),
    field<&S::start>("start", "m", 0, 5, "distance from the root over which waves grow to full size"),
    field<&S::turnDegrees>("turnDegrees", "°", -180, 180,
                           "direction of the waves: 0 is along the skin, 90 out of it"),
    field<&S::phaseVariation>("phaseVariation", "", 0, 1,
                              "1 starts each strand at a random phase, 0 starts all at the same phase"),
    field<&S::amplitudeVariation>("amplitudeVariation", "", 0, 1,
                                  "largest random reduction of the waves per strand"),
    clearanceField<&S::clearance>(),
    seedField<&S::seed>("seed", "random seed of the variation"),
};
constexpr const char* kFormulaFields[] = {"amplitude",   "frequency",      "start",
                                          "turnDegrees", "phaseVariation", "amplitudeVariation"};
std::span<const Field<S>> fieldsOf(const S&) {
    return kFields;
}

constexpr float kSegmentsPerWave = 4;

Result<std::size_t> wave(Groom& groom, const Varied<S>& varied, const Region& region) {
    if (auto status = checkFields("wave", varied.base()); !status) return tl::unexpected(status.error());
    const EditOptions options{varied.base().clearance, Turns::asMade, true};
    return editStrands(groom, region, options, [&](StrandEdit& strand) {
        const S settings = varied.at(strand.index);
        const float total = strand.totalLength();
        if (!(total > 0)) return;
        Random random = strand.random(settings.seed);
        const float phase = 2 * kPi * settings.phaseVariation * random.uniform();
        const float amplitude = settings.amplitude * (1 - settings.amplitudeVariation * random.uniform());
        const float finest = static_cast<float>(strand.lengths.size()) / (kSegmentsPerWave * total);
        const float rate = 2 * kPi * std::min(settings.frequency, finest);
        const float turn = radians(settings.turnDegrees);
        const auto frames = strandFrames(strand.points, strand.outward());
        float arc = 0;
        for (std::size_t i = 1; i < strand.points.size(); ++i) {
            arc += strand.lengths[i - 1];
            const float grown = settings.start > 0 ? std::min(arc / settings.start, 1.0f) : 1.0f;
            const Vec3f aside = std::cos(turn) * frames[i].lateral + std::sin(turn) * frames[i].outward;
            strand.points[i] += amplitude * grown * std::sin(phase + rate * arc) * aside;
        }
        restoreLengthsByDirection(strand.points, strand.lengths);
    });
}

}  // namespace

Operation waveOperation() {
    return variedOperation<S, wave, kFormulaFields>("wave", 46, "adds flat waves to strands");
}

}  // namespace hairloom
