// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The reference with as many substeps as its result needs.

#include <functional>

#include "core/simulation/reference/solver.h"

namespace hairloom::reference {

struct Goal {
    double tolerance = 1e-6;               ///< m, see Convergence::change
    std::uint32_t firstSubsteps = 4;       ///< per frame
    std::uint32_t maxSubsteps = 4096;      ///< per frame, never exceeded
    int order = 4;                         ///< see StepOptions
    std::function<bool()> cancelled = {};  ///< asked before each frame; true ends it with an error
};

struct Convergence {
    bool reached = false;        ///< change is at most the tolerance, and no step of the last run failed
    std::uint32_t substeps = 0;  ///< per frame, of the last run
    /// Largest distance between a point of the last run and of the one with half the substeps, at the end of
    /// any frame, m; infinite after a single run. A scheme of order k is off by about change/(2^k − 1).
    double change = 0.0;
    std::vector<double> changes;  ///< of each doubling, in order; their ratios show the order
    StepReport report;            ///< of the last run, over all frames
    std::vector<std::vector<Vec3d>> positions_ws;  ///< of the last run, per frame
    std::vector<std::vector<Vec3d>> coarser_ws;  ///< of the run before it, likewise; empty after a single run
    std::vector<Vec3d> velocities_ws;            ///< of the last run, at its end
};

/// Runs all frames from rest on `start`, again and again with twice the substeps, until the change is within
/// the tolerance. Chaotic motion never gets there; `reached` says so. Errors: as Solver::make, being
/// cancelled.
Result<Convergence> converged(const Strands& strands, const runtime::SimulationSettings& settings,
                              std::span<const Root> start, std::span<const Frame> frames,
                              const Goal& goal = {}, BendingForce bendingForce = BendingForce::framesHeld);

}  // namespace hairloom::reference
