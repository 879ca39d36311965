// SPDX-License-Identifier: MIT
#pragma once
// The plan: which effects a scene needs, why, and the stages that follow. Derived from authored settings and
// the frame's geometry, cheap enough to be made every frame, without memory of its own.

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "runtime/settings.h"
#include "runtime/strands.h"

namespace hairloom::runtime {

enum class Effect : std::uint32_t { gravity, drag, wind, angular, length, collision };
inline constexpr std::uint32_t kEffectCount = 6;
const char* effectName(Effect effect);

/// A pass over one block of strands. A substep runs the plan's stages in their order.
enum class StageId : std::uint32_t {
    roots,      ///< moves clamped points with the scalp
    gravity,    ///< external force
    drag,       ///< external force: still air
    wind,       ///< external force: moving air
    penalty,    ///< force of spheres, collisionResponse penalty
    integrate,  ///< Verlet (Rünz 2012, Eq. 10) with damping
    angular,    ///< angular springs (Eq. 4)
    length,     ///< length constraint, Newton steps
    sweep,      ///< spheres that fast points pass through within a substep
    collision,  ///< spheres and pearls (Eqs. 13–21), collisionResponse radial
    backward,   ///< likewise, collisionResponse backward
    extension,  ///< maximal extension as post-processing (Provot 1995)
};
inline constexpr std::uint32_t kStageCount = 12;
const char* stageName(StageId stage);

/// What the plan looks at.
struct SceneDescription {
    SimulationSettings settings;
    std::uint32_t strandCount = 0;
    std::uint32_t longestPointCount = 0;   ///< of any strand
    float longestStrand = 0.0f;            ///< metres, at rest
    Float3 rootsMin_ws, rootsMax_ws;       ///< box of all roots over the frame
    std::span<const Sphere> spheres;       ///< at the end of the frame
    std::span<const Float3> sphereMotion;  ///< each sphere's way during the frame; empty when they rest
};

enum class Reason : std::uint32_t {
    authored,
    nothingToMove,
    zeroGravity,
    noAirDrag,
    windTakesOver,
    zeroSpeed,
    noDirection,
    zeroStiffness,
    zeroIterations,
    noSpheres,
    noneInReach,
    inReach,
};

struct Decision {
    bool on = false;
    Reason reason = Reason::nothingToMove;
    float value = 0.0f;  ///< the number that the words name
};

class EffectPlan {
  public:
    bool on(Effect effect) const { return decisions_[static_cast<std::size_t>(effect)].on; }
    Reason reason(Effect effect) const { return decisions_[static_cast<std::size_t>(effect)].reason; }
    /// In words: "collision: off, no sphere within reach of a strand".
    std::string why(Effect effect) const;
    /// In the order in which a substep runs them.
    std::span<const StageId> stages() const { return {stages_.data(), stageCount_}; }

  private:
    friend EffectPlan plan(const SceneDescription& scene);
    void add(StageId stage) { stages_[stageCount_++] = stage; }

    std::array<Decision, kEffectCount> decisions_;
    std::array<StageId, kStageCount> stages_{};
    std::size_t stageCount_ = 0;
};

EffectPlan plan(const SceneDescription& scene);

}  // namespace hairloom::runtime
