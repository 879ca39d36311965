// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/operations/noise.h"

#include <algorithm>
#include <cmath>

#include "core/operations/length_constraint.h"
#include "core/operations/operation.h"
#include "core/operations/strand_frames.h"

namespace hairloom {
namespace {

using S = NoiseSettings;

constexpr Field<S> kFields[] = {
    field<&S::amplitude>("amplitude", "m", 0, 0.1, "size of the waves at the tip"),
    field<&S::frequency>("frequency", "1/m", 0, 1000,
                         "waves per metre of hair, limited to one wave per four segments"),
    field<&S::rootShare>("rootShare", "", 0, 1,
                         "amplitude at the root as a share of the amplitude at the tip"),
    clearanceField<&S::clearance>(),
    seedField<&S::seed>("seed", "random seed of the waves"),
};
constexpr const char* kFormulaFields[] = {"amplitude", "frequency", "rootShare"};

constexpr float kSegmentsPerWave = 4;

}  // namespace

std::span<const Field<S>> fieldsOf(const S&) {
    return kFields;
}

void noiseStrand(std::span<Vec3f> points, std::span<const float> lengths, const NoiseSettings& settings,
                 std::uint64_t stream) {
    float total = 0;
    for (const float length : lengths) total += length;
    if (!(total > 0)) return;
    const float finest = static_cast<float>(lengths.size()) / (kSegmentsPerWave * total);
    const float frequency = std::min(settings.frequency, finest);
    const Vec3f start = waveAt(stream, 0);
    float arc = 0;
    for (std::size_t i = 1; i < points.size(); ++i) {
        arc += lengths[i - 1];
        const float share = settings.rootShare + (1 - settings.rootShare) * arc / total;
        points[i] += settings.amplitude * share * (waveAt(stream, arc * frequency) - start);
    }
    restoreLengthsByDirection(points, lengths);
}

namespace {

Result<std::size_t> noiseVaried(Groom& groom, const Varied<S>& varied, const Region& region) {
    if (auto status = checkFields("noise", varied.base()); !status) return tl::unexpected(status.error());
    return editStrands(groom, region, {varied.base().clearance, Turns::asMade}, [&](StrandEdit& strand) {
        const S settings = varied.at(strand.index);
        Random random = strand.random(settings.seed);
        noiseStrand(strand.points, strand.lengths, settings, random.next());
    });
}

}  // namespace

Result<std::size_t> noise(Groom& groom, const S& settings, const Region& region) {
    return noiseVaried(groom, settings, region);
}

Operation noiseOperation() {
    return variedOperation<S, noiseVaried, kFormulaFields>(
        "noise", 40, "bends strands at random, for frizz or an uneven fall");
}

}  // namespace hairloom
