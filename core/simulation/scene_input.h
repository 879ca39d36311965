// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A groom and its poses in the form that solvers of strands take.

#include <vector>

#include "core/simulation/motion.h"
#include "hairloom/strands.h"

namespace hairloom {

/// Of collision spheres in a pose; metres, world.
std::vector<runtime::Sphere> spheresAt(std::span<const CollisionSphere> spheres, const HeadPose& pose);

/// Which of the groom's spheres stand for its skin collider; empty without one.
runtime::Vector<std::uint8_t> skinSpheresOf(const Groom& groom);

/// The groom's strands at rest; lives as long as its arrays.
runtime::StrandsView strandsAtRest(const Groom& groom);

runtime::BonePose toBonePose(const Eigen::Affine3f& m);
/// Of the groom's body in a pose, as FrameInput::body_ws takes them. Empty: there is none, or the pose moves
/// the head by bones that it does not tell.
std::vector<runtime::BonePose> bodyAt(const Groom& groom, const HeadPose& pose);

class SceneInput {
  public:
    /// Errors: no strands, a groom that validate() finds errors in.
    static Result<SceneInput> make(const Groom& groom);

    const Groom& groom() const { return groom_; }
    void setSettings(const runtime::SimulationSettings& settings) { groom_.simulation = settings; }
    /// `atRest`: they are where the groom's are; others do not tell what they would be at rest.
    void setSpheres(std::vector<CollisionSphere> spheres, bool atRest = true);
    /// Lives as long as this.
    runtime::StrandsView strands() const;
    /// One per strand; metres, world.
    std::vector<runtime::RootFrame> rootsAt(const HeadPose& pose) const;
    std::vector<runtime::Sphere> spheresAt(const HeadPose& pose) const;
    /// As Engine::setSkinSpheres() takes them; empty without a body.
    std::span<const std::uint8_t> skinSpheres() const { return skinSpheres_; }
    /// The rigid motion that the roots have on the whole: their mean rotation, about their middle.
    runtime::RootFrame headAt(const HeadPose& pose) const;

  private:
    explicit SceneInput(const Groom& groom);
    std::vector<Eigen::Isometry3f> rootTransforms(const HeadPose& pose) const;

    Groom groom_;
    std::vector<SurfacePoint> bindings_;  ///< empty for hair without a scalp
    runtime::Vector<std::uint8_t> skinSpheres_;
};

}  // namespace hairloom
