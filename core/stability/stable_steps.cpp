// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/stability/stable_steps.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "hairloom/stable.h"

namespace hairloom {
namespace {

constexpr std::size_t kMostStrands = 2000;

}  // namespace

std::vector<StableStep> stableSteps(const Groom& groom) {
    const std::size_t every = (groom.strandCount() + kMostStrands - 1) / kMostStrands;
    std::vector<std::uint32_t> offsets{0};
    std::vector<runtime::Float3> positions;
    for (std::size_t s = 0; s < groom.strandCount(); s += every) {
        for (const Vec3f& point : groom.strand(s)) positions.push_back({point.x(), point.y(), point.z()});
        offsets.push_back(static_cast<std::uint32_t>(positions.size()));
    }
    const runtime::StrandsView strands{offsets, positions};
    runtime::SimulationSettings settings = groom.simulation;
    const bool rods = settings.strandModel == runtime::StrandModel::rods;
    std::vector<StableStep> steps{{"rods", std::numeric_limits<double>::infinity(), rods}};
    settings.strandModel = runtime::StrandModel::springs;
    const runtime::FastestWaves waves = runtime::fastestWaves(strands, settings);
    const auto names = runtime::integratorNames();
    for (std::size_t i = 0; i < names.size(); ++i) {
        settings.integrator = static_cast<runtime::Integrator>(i);
        steps.push_back({std::string(names[i]), runtime::longestStableStep(waves, settings),
                         !rods && settings.integrator == groom.simulation.integrator});
    }
    return steps;
}

std::string failureInWords(const StableStep& step) {
    if (!(step.longest > 0)) return "fails at any step";
    if (std::isinf(step.longest)) return "fails at no step";
    return fmt::format("fails beyond a substep of {:.2g} ms", 1e3 * step.longest);
}

}  // namespace hairloom
