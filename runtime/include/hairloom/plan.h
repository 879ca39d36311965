// SPDX-License-Identifier: MIT
#pragma once
// The plan: which effects a scene needs, why, and the stages that follow. Derived from authored settings and
// the frame's geometry, cheap enough to be made every frame, without memory of its own.

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "hairloom/effects.h"
#include "hairloom/settings.h"
#include "hairloom/strands.h"

namespace hairloom::runtime {

/// What the plan looks at.
struct PlanInput {
    SimulationSettings settings;
    std::uint32_t strandCount = 0;
    std::uint32_t longestPointCount = 0;  ///< of any strand
    float longestStrand = 0.0f;           ///< metres, at rest
    bool straight = false;                ///< every strand is straight
    Float3 rootsMin_ws, rootsMax_ws;      ///< box of all roots over the frame
    std::span<const Sphere> spheres;      ///< at the end of the frame
    std::span<const Float3>
        sphereMotion;          ///< each sphere's displacement during the frame; empty when they rest
    float fastest = 0.0f;      ///< metres in a substep that a point can move relative to a sphere;
                               ///< infinite where nobody knows
    std::uint32_t asleep = 0;  ///< strands at rest
    float restTime = 0.0f;     ///< seconds for which all strands have been at rest
    float hairCell = 0.0f;     ///< metres, of the cells of hair-hair collision; 0 without
    std::uint32_t poses = 0;   ///< that strands can follow
    float poseAmount = 0.0f;   ///< the greatest of theirs
};

struct Decision {
    bool on = false;
    Reason reason = Reason::nothingToMove;
    float value = 0.0f;  ///< the number that the words name
};

/// More than any integrator lists.
inline constexpr std::size_t kMaxStages = 64;

class EffectPlan {
  public:
    bool on(Effect effect) const { return decisions_[static_cast<std::size_t>(effect)].on; }
    Reason reason(Effect effect) const { return decisions_[static_cast<std::size_t>(effect)].reason; }
    /// In words: "collision: off, no sphere within reach of a strand".
    std::string why(Effect effect) const;
    /// In the order in which a substep runs them; empty while all strands sleep.
    std::span<const StageId> stages() const { return {stages_.data(), stageCount_}; }
    /// Angular springs are solved as one system along each strand.
    bool factored() const { return factored_; }
    /// They are, where lengths are held, and segments keep their tension from substep to substep.
    bool keepsTensions() const { return keepsTensions_; }

  private:
    friend class PlanBuilder;

    std::array<Decision, kEffectCount> decisions_;
    std::array<StageId, kMaxStages> stages_{};
    std::size_t stageCount_ = 0;
    bool factored_ = false;
    bool keepsTensions_ = false;
};

EffectPlan plan(const PlanInput& scene);

/// Metres from its root that a strand of that length can reach, with its collision radius; infinite while
/// nothing bounds its extension.
float hairReach(const SimulationSettings& settings, float strandLength);

}  // namespace hairloom::runtime
