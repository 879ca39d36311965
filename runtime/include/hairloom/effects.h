// SPDX-License-Identifier: MIT
#pragma once
// What a plan is made of: effects, stages, and reasons why an effect is on or off, each with its words. One
// more is a line in its enumeration and a line in the table below it.

#include <array>
#include <cstdint>
#include <optional>

namespace hairloom::runtime {

enum class Effect : std::uint32_t {
    damping,
    gravity,
    drag,
    wind,
    length,   ///< length constraint or coil springs, with maximal extension
    angular,  ///< angular or flexion springs
    torsion,  ///< frames carried along the strands, for angular springs of hair that is not straight
    collision,
    collisionRadius,      ///< distance that points keep from spheres
    continuousCollision,  ///< collisions between the positions of two substeps
    hairHair,             ///< pressure and friction of the hair around
    sleep,                ///< strands at rest are left out
    pose,                 ///< strands follow poses
};
inline constexpr std::uint32_t kEffectCount = static_cast<std::uint32_t>(Effect::pose) + 1;

struct EffectInfo {
    const char* name;
    const char* amount = "";  ///< in words, # for the number: "to 1/e in # s"
    /// Settings, by name, that turn it off when all their components are 0; none where it follows from the
    /// hair or the scene.
    std::array<const char*, 2> turnedOffBy{};
};
inline constexpr std::array<EffectInfo, kEffectCount> kEffects{{
    {"damping", "to 1/e in # s", {"dampingTime"}},
    {"gravity", "# m/s²", {"gravity"}},
    {"drag", "# per second", {"airDrag"}},
    {"wind", "# m/s", {"windSpeed"}},
    {"length", "# iteration(s)", {"lengthIterations"}},
    {"angular", "stiffness #", {"angularStiffness"}},
    {"torsion"},
    {"collision"},
    {"collisionRadius", "up to # mm", {"collisionRadiusRoot", "collisionRadiusTip"}},
    {"continuousCollision"},
    {"hairHair", "cells of # mm", {"hairHair"}},
    {"sleep", "", {"sleepSpeed"}},
    {"pose", "amount #"},
}};
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
    angularSmallAngle,   ///< angular (Eq. 4) towards the rest position
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

struct StageInfo {
    const char* name;    ///< the kernel of a GPU is called so, too: stageRoots()
    const char* family;  ///< column of Table 3 of the thesis that its time belongs to
    std::optional<Effect> effect = std::nullopt;  ///< that it is there for; none for those of every strand
};
inline constexpr std::array<StageInfo, kStageCount> kStages{{
    {"roots", "animation"},
    {"rod", "integration"},
    {"damping", "integration", Effect::damping},
    {"drag", "external forces", Effect::drag},
    {"wind", "external forces", Effect::wind},
    {"gravity", "external forces", Effect::gravity},
    {"springs", "linear forces", Effect::length},
    {"angularSmallAngle", "angular forces", Effect::angular},
    {"angularExact", "angular forces", Effect::angular},
    {"straightSmallAngle", "angular forces", Effect::angular},
    {"straightExact", "angular forces", Effect::angular},
    {"flexion", "angular forces", Effect::angular},
    {"penalty", "collision", Effect::collision},
    {"verlet", "integration"},
    {"open", "integration"},
    {"openHalfway", "integration"},
    {"explicitEuler", "integration"},
    {"leapfrog", "integration"},
    {"verletDrift", "integration"},
    {"verletEvaluationState", "integration"},
    {"verletKick", "integration"},
    {"rungeKutta1", "integration"},
    {"rungeKutta2", "integration"},
    {"rungeKutta3", "integration"},
    {"rungeKutta4", "integration"},
    {"implicitFree", "integration"},
    {"implicitBend", "integration"},
    {"implicitSpring", "integration"},
    {"implicitSpringBend", "integration"},
    {"angular", "angular forces", Effect::angular},
    {"angularStraight", "angular forces", Effect::angular},
    {"length", "linear forces", Effect::length},
    {"lengthNow", "linear forces", Effect::length},
    {"springLimit", "post-processing", Effect::length},
    {"collision", "collision", Effect::collision},
    {"collisionBack", "collision", Effect::collision},
    {"continuousCollision", "collision", Effect::continuousCollision},
    {"extension", "post-processing", Effect::length},
    {"lengthRate", "linear forces", Effect::length},
}};
const char* stageName(StageId stage);
const char* stageFamily(StageId stage);
std::optional<Effect> stageEffect(StageId stage);

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
    flatSection,
    byRods,
    noCollision,
    zeroRadius,
    slowEnough,
    fast,
    speedUnknown,
    byForce,
    notAuthored,
    ofRodsAlone,
    neverAsleep,
    allAwake,
    someAsleep,
    allAsleep,
    noPose,
    zeroAmount,
    noPoseOfSprings,
};
inline constexpr std::uint32_t kReasonCount = static_cast<std::uint32_t>(Reason::noPoseOfSprings) + 1;
/// In words, # for the number.
inline constexpr std::array<const char*, kReasonCount> kReasons{
    "",  // what EffectInfo::amount says
    "zero time",
    "no point of any strand is free",
    "zero gravity",
    "air drag is zero, so hair does not feel air",
    "part of the wind",
    "zero speed",
    "no direction",
    "zero stiffness",
    "zero iterations",
    "no spheres",
    "no sphere within reach of a strand",
    "# sphere(s) within reach",
    "coil springs of # Hz",
    "no angular springs",
    "flexion springs need no frames",
    "hair is straight",
    "hair is curved or carries its weight",
    "a flat section twists",
    "rods have no other length",
    "no collision",
    "zero radius",
    "nothing moves by a quarter of a sphere's radius in a substep",
    "up to # mm in a substep",
    "speeds are not known beforehand",
    "penalty forces act on what is inside",
    "not asked for",
    "springs do not meet hair",
    "zero sleep speed",
    "all strands move",
    "# strand(s) at rest",
    "all strands at rest since # s",
    "no pose",
    "zero amount",
    "springs follow no pose",
};

}  // namespace hairloom::runtime
