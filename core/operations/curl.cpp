// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/operations/curl.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/curve.h"
#include "core/operations/length_constraint.h"
#include "core/operations/operation.h"

namespace hairloom {
namespace {

using S = CurlSettings;

constexpr Field<S> kFields[] = {
    field<&S::radius>("radius", "m", 0, 0.1, "radius of the helix"),
    field<&S::frequency>("frequency", "1/m", 0, 500,
                         "turns per metre of hair, limited to one turn per four segments"),
    field<&S::start>("start", "m", 0, 5, "distance from the root over which the radius grows to full size"),
    field<&S::phaseVariation>("phaseVariation", "", 0, 1,
                              "1 starts each strand at a random angle, 0 starts all at the same angle"),
    clearanceField<&S::clearance>(),
    seedField<&S::seed>("seed", "random seed of the angles"),
};
constexpr const char* kFormulaFields[] = {"radius", "frequency", "start", "phaseVariation"};

constexpr float kSegmentsPerTurn = 4;

}  // namespace

std::span<const Field<S>> fieldsOf(const S&) {
    return kFields;
}

void curlStrand(std::span<Vec3f> points, std::span<const float> lengths, const CurlSettings& settings,
                float phase) {
    float total = 0;
    for (const float length : lengths) total += length;
    if (!(total > 0)) return;
    const float finest = static_cast<float>(lengths.size()) / (kSegmentsPerTurn * total);
    const float rate = 2 * kPi * std::min(settings.frequency, finest);
    const auto frames = parallelTransportFrames(points, Vec3f::UnitX());
    float arc = 0;
    for (std::size_t i = 1; i < points.size(); ++i) {
        arc += lengths[i - 1];
        const float grown = settings.start > 0 ? std::min(arc / settings.start, 1.0f) : 1.0f;
        const float angle = phase + rate * arc;
        points[i] += settings.radius * grown *
                     (std::cos(angle) * frames[i].col(0) + std::sin(angle) * frames[i].col(1));
    }
    restoreLengthsByDirection(points, lengths);
}

namespace {

Result<std::size_t> curlVaried(Groom& groom, const Varied<S>& varied, const Region& region) {
    if (auto status = checkFields("curl", varied.base()); !status) return tl::unexpected(status.error());
    return editStrands(groom, region, {varied.base().clearance, Turns::asMade}, [&](StrandEdit& strand) {
        const S settings = varied.at(strand.index);
        const float phase = 2 * kPi * settings.phaseVariation * strand.random(settings.seed).uniform();
        curlStrand(strand.points, strand.lengths, settings, phase);
    });
}

}  // namespace

Result<std::size_t> curl(Groom& groom, const S& settings, const Region& region) {
    return curlVaried(groom, settings, region);
}

Operation curlOperation() {
    return variedOperation<S, curlVaried, kFormulaFields>("curl", 50, "curls strands into helices");
}

}  // namespace hairloom
