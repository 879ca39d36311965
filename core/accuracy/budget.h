// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The most exact settings that a scene can have for so many milliseconds a frame on this machine, and what is
// given up for it.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/accuracy/ground_truth.h"
#include "core/cost/statistics.h"

namespace hairloom {

struct BudgetOptions {
    // One of them.
    std::optional<double>
        milliseconds;                ///< per frame, > 0, of all strands: the most exact that takes no more
    std::optional<double> withinMm;  ///< > 0, root mean square: the cheapest that is as exact
    /// Milliseconds of a frame of all strands with the settings of that groom, where they run: a GPU that
    /// draws them, too. Empty: the engine on the CPU, alone.
    std::function<Result<double>(const Groom&)> frameTime;
    SceneTime time;               ///< stepsPerFrame is 1
    std::uint32_t strands = 100;  ///< ≥ 1; a sample that errors are taken from
    std::uint32_t repeats = 5;    ///< timed runs of each candidate, ≥ 1
    std::uint64_t seed = 1;       ///< of the sample
    /// Called with what is being done, and how much of it.
    std::function<void(const std::string& what, std::size_t done, std::size_t total)> progress;
};

/// Something that the scene has as authored and the solution has not.
struct GivenUp {
    std::string what;      ///< "substeps", "points", "collision"
    std::string from, to;  ///< "8", "2"; "on", "off"
};

struct Budget {
    bool fits = false;  ///< else this is the fastest that was found
    Groom groom;        ///< with the settings chosen, resampled where `points` is given up
    Quartiles milliseconds;
    double millisecondsAgain = 0;  ///< median of runs of the choice once more, when all was done
    /// The runs of the choice differ by too much, and its times cannot be relied upon.
    bool busy() const;
    double errorMm = 0;  ///< root mean square, of the sample
    double errorMaxMm = 0;
    Quartiles authoredMilliseconds;  ///< of the scene as it is
    std::vector<GivenUp> givenUp;    ///< in the order of the settings, then effects in the order of giving up
    std::vector<std::string> notes;  ///< whole sentences
};

/// Share by which times of the same may differ where they are to be relied upon.
inline constexpr double kSteadyShare = 0.15;

/// Tries substeps, corrections of length and points per strand at and below those authored, and more substeps
/// where the budget has room; of those that are as exact as possible for their time, the most exact that fits
/// all strands. Where none fits, effects are turned off besides, each time the one that costs the least
/// exactness for the time it saves; where frames are drawn, follow hairs go first. Torsion, continuous
/// collision, gravity, damping, sleep and the length constraint stay. Errors: a groom that cannot be
/// simulated, those of the truth.
Result<Budget> solveBudget(const Groom& groom, const HeadMotion& motion, const BudgetOptions& options,
                           const GroundTruthSource& groundTruth);

}  // namespace hairloom
