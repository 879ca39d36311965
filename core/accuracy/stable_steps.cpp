// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/accuracy/stable_steps.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "hairloom/stable.h"

namespace hairloom {

std::vector<StableStep> stableSteps(const Groom& groom) {
    static_assert(sizeof(Vec3f) == sizeof(runtime::Float3));
    const auto positions = groom.positions();
    runtime::StrandsView strands;
    strands.offsets = groom.offsets.view();
    strands.restPositions_ss = {reinterpret_cast<const runtime::Float3*>(positions.data()), positions.size()};
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
