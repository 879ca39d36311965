// SPDX-License-Identifier: MIT
#pragma once
// The plan: which effects a scene needs, why, and the stages that follow. Derived from authored settings and
// the frame's geometry, cheap enough to be made every frame, without memory of its own.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "hairloom/settings.h"
#include "hairloom/strands.h"

namespace hairloom::runtime {

enum class Effect : std::uint32_t {
    damping,
    gravity,
    drag,
    wind,
    length,    ///< length constraint or coil springs, with maximal extension
    angular,   ///< angular or flexion springs
    torsion,   ///< frames carried along the strands, for angular springs of hair that is not straight
    collision,
    collisionRadius,      ///< distance that points keep from spheres
    continuousCollision,  ///< collisions between the positions of two substeps
    sleep,                ///< strands at rest are left out
};
inline constexpr std::uint32_t kEffectCount = 11;
const char* effectName(Effect effect);

/// A pass over one block of strands. A substep runs the plan's stages in their order; an integrator that
/// evaluates forces several times lists them several times.
enum class StageId : std::uint32_t {
    roots,    ///< moves clamped points with the scalp
    rod,      ///< elastic rods: all that moves them, in one solve
    damping,  ///< slows motion relative to the root
    // Forces: each adds a·h² to the displacement of the free points.
    drag,                ///< external: still air
    wind,                ///< external: moving air
    gravity,             ///< external
    springs,             ///< linear: coil springs (Eq. 3)
    angularSmallAngle,   ///< angular (Eq. 4) towards the rest place
    angularExact,        ///< angular (Eq. 4) across the segment
    straightSmallAngle,  ///< as angularSmallAngle, for straight hair: no frames
    straightExact,       ///< as angularExact, for straight hair: no frames
    flexion,             ///< springs between every second point
    penalty,             ///< springs out of spheres
    // Integration.
    verlet,                 ///< Eq. 10
    open,                   ///< forces are evaluated at the start of the substep
    openHalfway,            ///< forces are evaluated after half a drift
    explicitEuler,          ///< Eq. 7
    leapfrog,               ///< kick and second half drift
    verletDrift,            ///< velocity Verlet, Eq. 12: first half kick and drift
    verletEvaluationState,  ///< velocity Verlet: forces are evaluated again where the constraints have put
                            ///< the points
    verletKick,             ///< velocity Verlet: second half kick
    rungeKutta1,            ///< RK4: takes the first slope
    rungeKutta2,            ///< RK4: takes the second slope
    rungeKutta3,            ///< RK4: takes the third slope
    rungeKutta4,            ///< RK4: takes the fourth slope and the step
    implicitFree,           ///< backward Euler (Eq. 9) without stiff forces
    implicitBend,           ///< backward Euler with angular springs
    implicitSpring,         ///< backward Euler with coil springs
    implicitSpringBend,     ///< backward Euler with coil and angular springs
    // After it.
    angular,              ///< angular springs, implicitly, with frames (Eq. 4)
    angularStraight,      ///< the same for straight hair: no frames
    length,               ///< length constraint, Newton steps along the gradients at the start of the substep
    lengthNow,            ///< the same along the gradients of now
    springLimit,          ///< maximal extension by velocities (Bridson et al. 2003)
    collision,            ///< spheres (Eqs. 13–21), out along the radius
    collisionBack,        ///< spheres, back along the way
    continuousCollision,  ///< first contact of fast points with spheres
    extension,            ///< maximal extension by positions (Provot 1995)
    lengthRate,           ///< takes out velocity that would change lengths (RATTLE)
};
inline constexpr std::uint32_t kStageCount = static_cast<std::uint32_t>(StageId::lengthRate) + 1;
const char* stageName(StageId stage);
/// Column of Table 3 of the thesis that a stage's time belongs to.
const char* stageFamily(StageId stage);
/// The effect that a stage is there for; none for those that every strand needs.
std::optional<Effect> stageEffect(StageId stage);

/// What the plan looks at.
struct PlanInput {
    SimulationSettings settings;
    std::uint32_t strandCount = 0;
    std::uint32_t longestPointCount = 0;   ///< of any strand
    float longestStrand = 0.0f;            ///< metres, at rest
    bool straight = false;                 ///< every strand is straight
    Float3 rootsMin_ws, rootsMax_ws;       ///< box of all roots over the frame
    std::span<const Sphere> spheres;       ///< at the end of the frame
    std::span<const Float3> sphereMotion;  ///< each sphere's way during the frame; empty when they rest
    float fastest = 0.0f;      ///< metres in a substep that a point can move relative to a sphere;
                               ///< infinite where nobody knows
    std::uint32_t asleep = 0;  ///< strands at rest
    float restTime = 0.0f;     ///< seconds for which all strands have been at rest
};

enum class Reason : std::uint32_t {
    authored,
    zeroTime,
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
    springsOn,
    noAngular,
    noFrames,
    straightHair,
    curvedHair,
    byRods,
    noCollision,
    zeroRadius,
    slowEnough,
    fast,
    speedUnknown,
    byForce,
    neverAsleep,
    allAwake,
    someAsleep,
    allAsleep,
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
    friend EffectPlan plan(const PlanInput& scene);
    friend class Planner;

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
