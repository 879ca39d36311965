// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The strand engine with knobs that a person turns while it runs: settings and spheres.

#include <memory>
#include <vector>

#include "core/simulation/simulation.h"
#include "core/simulation/strand_method.h"

namespace hairloom::editor {

/// What a running simulation looks at before each step.
struct LiveParameters {
    StrandMethod* engine = nullptr;        ///< set when the simulation has been made; null of another method
    std::vector<CollisionSphere> spheres;  ///< in place of the groom's
};

/// For SimulationOptions::backend. `knobs->engine` is valid while the simulation lives.
MethodMaker liveMethod(std::shared_ptr<LiveParameters> parameters);

}  // namespace hairloom::editor
