// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What hair may do wrong besides being elsewhere than the reference: sink, not come back, tremble, and be in
// what it lies on.

#include <span>
#include <vector>

#include "core/cost/scene_run.h"

namespace hairloom {

struct OtherErrors {
    /// Root mean square over points, mm: from where they are authored to where they are after some seconds
    /// of rest; and from there to where they come to rest once the head has been shaken for a second.
    double dropMm = 0, returnMm = 0;
    double restSpeed = 0;                       ///< m/s, of the fastest point at the end of both rests
    double headDepthMm = 0, sphereDepthMm = 0;  ///< deepest in the head's mesh and in spheres, in any frame

    double depthMm() const { return headDepthMm > sphereDepthMm ? headDepthMm : sphereDepthMm; }
};

/// Sets dropMm, returnMm and restSpeed: the head stands as in `pose`, is shaken, and stands again, in still
/// air. Motion is damped at least as fast as by default, so that hair does not swing on. Infinite where a
/// point is no number. Errors: those of Simulation::make.
Status measureRest(SceneHair hair, const HeadPose& pose, const SimulationOptions& options,
                   OtherErrors& errors);

/// How deep points of each trajectory are in the head at most, mm; 0 without one. poses[0] is the start, and
/// a frame of the trajectories is one step. What is empty or not finite is 0.
std::vector<double> headDepths(const Groom& groom, std::span<const HeadPose> framePoses,
                               std::span<const Trajectory* const> trajectories);

}  // namespace hairloom
