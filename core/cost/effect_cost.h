// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What each effect of a scene costs: the scene as it is, and once more without it.

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/cost/scene_run.h"
#include "core/cost/statistics.h"

namespace hairloom {

struct EffectCostOptions {
    SceneTime time;             ///< stepsPerFrame is 1
    std::uint32_t repeats = 5;  ///< timed runs with and without each effect, ≥ 1
    /// A sample of so many runs of a larger groom; times are those of all in proportion, memory is the
    /// sample's.
    std::size_t strands = std::numeric_limits<std::size_t>::max();
    std::function<void(std::size_t done, std::size_t total)> progress;
    std::function<bool()> cancelled;  ///< asked between runs; true ends them with an error
};

struct EffectCost {
    std::string name;
    bool on = false;
    std::string why;          ///< "off, zero speed"
    std::string turnedOffBy;  ///< "simulation.windSpeed=0"; empty where it is off, or nothing turns it off
    /// Per frame without it; absent where it was not turned off or the hair was not finite without it.
    std::optional<Quartiles> millisecondsOff;
    /// The frame with it less that without, run by run of the same round. It may be negative: without wind
    /// there is still air, and loose hair meets more spheres.
    std::optional<Quartiles> costMilliseconds;
    double stageMilliseconds = 0;  ///< per frame, of the effect's own stages, summed over threads
    std::uint64_t bytes = 0;       ///< memory of its own
    std::string note;              ///< what else turning it off changed; may be empty

    /// What it adds to a frame, milliseconds: 0 while off; absent where that was not measured, is lost in
    /// the spread of the runs, or is negative. `note` says which.
    std::optional<double> price() const;
};

/// Whether zero lies between the quartiles of what an effect costs: the runs do not tell.
bool lostInSpread(const Quartiles& cost);

struct EffectCosts {
    Quartiles milliseconds;  ///< per frame, as the scene is
    std::vector<EffectCost> effects;
};

/// Which effects this scene calls for, after its last frame, and what they cost. Errors: those of
/// Simulation::make, and being cancelled.
Result<EffectCosts> measureEffectCosts(const Groom& groom, const HeadMotion& motion,
                                       const EffectCostOptions& options);

}  // namespace hairloom
