// SPDX-License-Identifier: GPL-3.0-or-later
// Guides into follow hairs on one thread, at rest and with speed-dependent wisps: bindings packed for the
// engine and evaluated once, as for a picture. `bench sim` times frames.

#include "benchmarks/measurement.h"
#include "benchmarks/sample_hair.h"
#include "core/accuracy/guide_grid.h"
#include "core/cost/thread_limit.h"
#include "core/interpolation/follow_hairs.h"

namespace hairloom::benchmarks {
namespace {

Status evaluate(Rounds& rounds, const Groom& groom, const FollowBindings& bindings, bool moving) {
    const ThreadLimit oneThread(1);
    const auto guides = guidePositions(groom, bindings);
    const std::vector<Vec3f> velocities(moving ? guides.size() : 0, Vec3f(1, 0, 0));
    std::vector<Vec3f> positions(bindings.hairCount() * bindings.pointsPerHair);
    while (rounds.next()) {
        auto status = evaluateFollowHairs(bindings, {guides, velocities, {}}, positions);
        if (!status) return status;
        keep(positions);
    }
    return {};
}

Status measure(Timings& timings, const std::string& name, const Groom& groom,
               const InterpolationSettings& settings) {
    const auto bindings = bindFollowHairs(groom, settings);
    if (!bindings) return tl::unexpected(bindings.error());
    const std::string hairs = name + ", " + std::to_string(bindings->hairCount()) + " hairs";
    timings.measure("follow at rest, " + hairs,
                    [&](Rounds& rounds) { return evaluate(rounds, groom, *bindings, false); });
    timings.measure("follow in motion, " + hairs,
                    [&](Rounds& rounds) { return evaluate(rounds, groom, *bindings, true); });
    timings.measure("bind, " + hairs, [&](Rounds& rounds) -> Status {
        while (rounds.next()) keep(bindFollowHairs(groom, settings));
        return {};
    });
    return {};
}

Result<Outcome> runInterpolate(const Options& options) {
    const auto& hairstyles = samples();
    if (!hairstyles) return tl::unexpected(hairstyles.error());
    Timings timings(options);
    for (const Sample& sample : *hairstyles) {
        if (auto status = measure(timings, sample.name, sample.groom, sample.groom.interpolation); !status)
            return tl::unexpected(status.error());
    }
    InterpolationSettings fiftyEach;
    fiftyEach.followPerGuide = 50;
    const Groom lawn = scenes::guidesOnGrid({50, 40, 16, 0.005f, 0.2f}, [](std::uint32_t) { return 0.05f; });
    if (auto status = measure(timings, "2,000 guides of 16 points", lawn, fiftyEach); !status)
        return tl::unexpected(status.error());
    return timings.outcome("interpolate");
}

}  // namespace

Benchmark interpolateBenchmark() {
    return {"interpolate", "guides into follow hairs", {"--quick"}, runInterpolate};
}

}  // namespace hairloom::benchmarks
