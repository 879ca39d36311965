// SPDX-License-Identifier: MIT
#pragma once
// Poses that rods follow (docs/engine.md, "Poses"): blended by their amounts into one pull on each node and
// one strain that each vertex rests at. Nothing is there while no amount is above 0.

#include <span>

#include "engine/poses.h"
#include "models/rods/rods.h"

namespace hairloom::runtime {

/// Of a pose of `amount` 0 … 1: how fast hair responds, 1/s. Its inverse is the time in which it comes.
float poseRate(float amount);

class RodPoses {
  public:
    /// As ModelStrands::takePoses(). `rest` is of the same settings.
    void take(const RestShape& shape, const SimulationSettings& settings, const RodRest& rest,
              const PoseChange& change, const Host& host);
    bool isOn() const { return !planes_.empty(); }
    std::size_t bytes() const { return (laid_.size() + planes_.size()) * sizeof(float); }
    /// Per block, kPlanes; empty while no pose is followed.
    const Floats& planes() const { return planes_; }
    /// Sets RodView's pose, poseRate and poseStrain.
    void show(const Block& block, RodView& view) const;

    /// Per block: where nodes are drawn to, in the root's frame; how fast, 1/s; the strain of vertices there.
    static constexpr std::size_t kPlanes = 7, kRatePlane = 3, kStrainPlane = 4;
    /// Floats of each point and lane while some of so many poses are followed.
    static std::size_t planesOf(std::size_t poses) { return poses > 0 ? kPlanes + kLaidPlanes * poses : 0; }

  private:
    /// As kPlanes, without the rate.
    static constexpr std::size_t kLaidPlanes = 6, kLaidStrain = 3;

    void lay(const RestShape& shape, const SimulationSettings& settings, const RodRest& rest,
             const PoseSet& poses, const Host& host);
    void blend(const RestShape& shape, const PoseSet& poses, std::span<const float> amounts,
               const Block& block);

    Floats laid_;    ///< per pose and block, kLaidPlanes
    Floats planes_;  ///< of what rods follow now
};

}  // namespace hairloom::runtime
