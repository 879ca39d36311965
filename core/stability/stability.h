// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The hard cases: scenes that make strand engines fail, each with every integrator and the thresholds that it
// has to meet. docs/stability.md has what came out.
//
// The settings are the defaults but for the integrator and what a case is about. Where theory
// (runtime/stable.h) says that an integrator needs shorter substeps, it gets them, up to 64 a frame; where
// these do not suffice, the case lies outside of what the integrator claims, and the result says at which
// substep it fails.

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/stability/hard_case_engine.h"
#include "hairloom/settings.h"

namespace hairloom {

/// One thing measured, held to a threshold.
struct StabilityThreshold {
    std::string what;
    std::string unit = {};   ///< "" for a pure number
    double worst = 0.0;      ///< greatest that was seen
    double threshold = 0.0;  ///< greatest allowed
    /// Whether the integrator promises to meet it. Those that hold lengths after bending has moved the points
    /// (all but position Verlet) promise neither rest nor a bound of the energy: the two undo part of each
    /// other's work, and hair may tremble.
    bool claimed = true;

    /// What is no number does not meet any threshold.
    bool met() const { return worst <= threshold; }
};

struct StabilityResult {
    int number = 0;
    std::string name;
    std::string family;
    std::string integrator;      ///< StabilityMethod::name
    std::uint32_t substeps = 0;  ///< a frame
    bool claimed = true;         ///< not where `limit` says why a threshold may be missed
    bool pass = false;           ///< every threshold is met
    std::vector<StabilityThreshold> thresholds;
    std::string limit;  ///< why the case, or what it misses of it, is not claimed; empty where it is
    std::optional<std::uint64_t> failedAt;  ///< substep in which a strand broke; absent where none did

    /// The threshold that is missed farthest, or met by the least.
    const StabilityThreshold& closest() const;
};

/// What moves the strands of a case: rods, or springs with an integrator.
struct StabilityMethod {
    runtime::StrandModel model = runtime::StrandModel::springs;
    runtime::Integrator integrator = runtime::Integrator::verlet;

    /// "rods", or the integrator's name.
    std::string name() const;
    bool rods() const { return model == runtime::StrandModel::rods; }
    friend bool operator==(const StabilityMethod&, const StabilityMethod&) = default;
};
inline constexpr StabilityMethod kRods{runtime::StrandModel::rods, runtime::Integrator::verlet};
inline StabilityMethod springsWith(runtime::Integrator integrator) {
    return {runtime::StrandModel::springs, integrator};
}

/// All, as settings list them.
std::vector<runtime::Integrator> allIntegrators();
/// Rods, then springs with each integrator.
std::vector<StabilityMethod> allStabilityMethods();

struct StabilityOptions {
    std::uint64_t stepsAtRest = 1'000'000;  ///< substeps of case 18, at least 8
    double freeSeconds = 60.0;              ///< of case 17, at least 2
    std::uint32_t storms = 40;              ///< of case 26
    /// What runs the cases; empty: the engine on the CPU. Another runs them one after the other.
    HardCaseEngineFactory engines = {};
    /// That `engines` can have.
    std::vector<runtime::Integrator> integrators = allIntegrators();
};

class HardCaseRun;

struct HardCase {
    int number;
    const char* name;
    const char* family;
    const char* scene;  ///< what happens, one sentence
    void (*run)(HardCaseRun&);
};

/// All, by number.
std::span<const HardCase> hardCases();

StabilityResult runHardCase(const HardCase& hardCase, const StabilityMethod& method,
                            const StabilityOptions& options = {});

/// Every case with each of the methods, side by side on threads; ordered by case, then as `methods`.
/// `progress` may be empty; it is called from any thread with the number of results so far.
std::vector<StabilityResult> runHardCases(std::span<const StabilityMethod> methods,
                                          const StabilityOptions& options = {},
                                          const std::function<void(std::size_t)>& progress = {});

}  // namespace hairloom
