// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/operations/length_constraint.h"
#include "core/operations/operation.h"
#include "core/operations/strand_frames.h"

namespace hairloom {
namespace {

struct BendSettings {
    float inwardDegrees = 40;
    float sidewaysDegrees = 0;
    float start = 0.5f;
    float variation = 0.2f;
    float clearance = 0.001f;
    std::uint64_t seed = 1;
};
using S = BendSettings;

constexpr Field<S> kFields[] = {
    field<&S::inwardDegrees>("inwardDegrees", "°", -360, 360,
                             "angle of the tip towards the head; negative bends away from it"),
    field<&S::sidewaysDegrees>("sidewaysDegrees", "°", -360, 360, "angle of the tip along the skin"),
    field<&S::start>("start", "", 0, 0.99, "share of the length where the bend begins"),
    field<&S::variation>("variation", "", 0, 1, "largest random reduction of the bend per strand"),
    clearanceField<&S::clearance>(),
    seedField<&S::seed>("seed", "random seed of the variation"),
};
constexpr const char* kFormulaFields[] = {"inwardDegrees", "sidewaysDegrees", "start", "variation"};
std::span<const Field<S>> fieldsOf(const S&) {
    return kFields;
}

Result<std::size_t> bend(Groom& groom, const Varied<S>& varied, const Region& region) {
    if (auto status = checkFields("bend", varied.base()); !status) return tl::unexpected(status.error());
    const EditOptions options{varied.base().clearance, Turns::asMade, true};
    return editStrands(groom, region, options, [&](StrandEdit& strand) {
        const S settings = varied.at(strand.index);
        const float total = strand.totalLength();
        if (!(total > 0)) return;
        const float own = 1 - settings.variation * strand.random(settings.seed).uniform();
        const auto frames = strandFrames(strand.points, strand.outward());
        Vec3f last = strand.points[0];
        float arc = 0;
        for (std::size_t i = 1; i < strand.points.size(); ++i) {
            arc += strand.lengths[i - 1];
            const float share = std::max(0.0f, (arc / total - settings.start) / (1 - settings.start)) * own;
            const Vec3f segment = strand.points[i] - last;
            last = strand.points[i];
            const Eigen::AngleAxisf inward(-radians(settings.inwardDegrees) * share, frames[i].lateral);
            const Eigen::AngleAxisf sideways(radians(settings.sidewaysDegrees) * share, frames[i].outward);
            strand.points[i] = strand.points[i - 1] + sideways * (inward * segment);
        }
        restoreLengthsByDirection(strand.points, strand.lengths);
    });
}

}  // namespace

Operation bendOperation() {
    return variedOperation<S, bend, kFormulaFields>("bend", 66, "bends tips in, out or to the side");
}

}  // namespace hairloom
