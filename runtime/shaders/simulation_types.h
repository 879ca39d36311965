// SPDX-License-Identifier: MIT
// What the strand kernels are told each frame, written once for HLSL and C++. Metres, seconds, world space.
#ifndef HAIRLOOM_SIMULATION_TYPES_H
#define HAIRLOOM_SIMULATION_TYPES_H
#include "types.h"

#ifdef __cplusplus
#include <cstddef>
namespace hairloom::shaders {
#endif

/// A float4 for each wave of the wind.
#define HAIRLOOM_WIND_MODES 6
/// Spheres that stand in a constant buffer; more stand in a buffer. As many as a word has bits.
#define HAIRLOOM_CONSTANT_SPHERES 32
/// Strands of a work group: a block of the engine, which falls asleep as one.
#define HAIRLOOM_GROUP_STRANDS 32
/// What says of a block how it rests, one after the other: seconds for which it was slow, 1 where it sleeps,
/// seconds for which it stayed, 1 where its anchors are to be moved to its points in the next frame. After
/// those of all blocks come the anchors of each: x, y, z of each anchor in all strands, metres.
#define HAIRLOOM_REST_NUMBERS 4
/// Points of a strand that say whether it stays: at each quarter of them, the tip last.
#define HAIRLOOM_REST_ANCHORS 4
/// Hair that stays in its place falls asleep after this many delays.
#define HAIRLOOM_STAY_DELAYS 5.0
/// Threads of a work group of one strand: the first takes it, as in the thesis' listing, which has 30 others.
#define HAIRLOOM_WISP_THREADS 32

/// Distance from a sphere's centre, as a share of the reach, below which a point leaves it across its strand.
#define HAIRLOOM_DEEP_IN_SPHERE 0.6

/// Share of a sphere's radius that a point may move in one substep without the test for continuous collision
/// looking at it: it can then cut no deeper than 0.8 % of the radius into it unseen.
#define HAIRLOOM_UNSWEPT_SHARE 0.25

/// As many work groups as a dispatch has along one axis.
#define HAIRLOOM_GROUP_ROW 65535

/// What the settings make of a substep, for the engine's kernels (SubstepContext) and those of the GPU alike.
struct SubstepNumbers {
    float velocityShare;  ///< exp(−h/dampingTime)
    float dragShare;  ///< share of the air's speed taken on: 1 − exp(−airDrag·h), or airDrag·h where an
                      ///< integrator evaluates forces
    float springStep;             ///< (ω h)² of coil springs
    float penaltyStep;            ///< (ω h)² of penalty springs
    float bendRate;               ///< q = bendDampingTime/h + (1 − velocityShare)/4 (docs/engine.md)
    float tensionShare;           ///< of a substep's change of tension that bending takes on
    float maximalExtension;       ///< share of a segment's length
    float collisionRadiusAtRoot;  ///< metres
    float collisionRadiusAtTip;   ///< metres
    float friction;
    float restitution;
    float slowestSwept;  ///< metres in a substep; slower points cannot pass a sphere unseen
};

struct SimulationConstants {
    uint slots;        ///< strands of the batch, with those that fill the last block
    uint substeps;     ///< per frame
    uint sphereCount;  ///< rods: of spheres that are the end of no capsule
    uint lengthIterations;
    uint wakingCount;          ///< spheres that have changed since the last frame
    uint windKind;             ///< runtime::WindKind
    uint wakeAll;              ///< not 0: nothing sleeps, as wind blows or velocities were changed
    float h;                   ///< seconds of a substep
    float dt;                  ///< seconds of the frame
    float rescale;             ///< this substep over the last frame's
    float teleportDistance;    ///< metres; negative: all that moves is cut
    float slowSquared;         ///< square metres in a substep; slower strands rest
    float sleepDelay;          ///< seconds
    uint groups;               ///< work groups of the batch, in rows of HAIRLOOM_GROUP_ROW
    float sphereDisplacement;  ///< metres; the longest way of a sphere in a substep
    float firstShare;  ///< of the ways of position Verlet in the frame's first substep: ½ from rest, else 1
    SubstepNumbers substep;
    float4 gravityStep;  ///< g h², w unused
    float4 originShift;  ///< metres by which the origin moves what was measured from it; w: 0
    float4 wind;         ///< mean velocity, m/s; w: strength of gusts
    float4 windAmplitudes[HAIRLOOM_WIND_MODES];  ///< m/s; w: phase at the start of the frame, turns
    float4 windWaves[HAIRLOOM_WIND_MODES];       ///< turns per metre; w: phase at the end of the frame
};

/// A collision sphere in one frame.
struct SphereConstants {
    float4 from;  ///< centre at the start of the frame; w: radius
    float4 step;  ///< the centre's displacement in one substep; w unused
};

#ifdef __cplusplus
static_assert(sizeof(SubstepNumbers) % 16 == 0 && offsetof(SimulationConstants, substep) == 64);
static_assert(offsetof(SimulationConstants, h) == 28 && offsetof(SimulationConstants, gravityStep) == 112);
static_assert(offsetof(SimulationConstants, windWaves) == 160 + 16 * HAIRLOOM_WIND_MODES);
static_assert(sizeof(SimulationConstants) == 160 + 32 * HAIRLOOM_WIND_MODES);
static_assert(sizeof(SphereConstants) == 32);
}  // namespace hairloom::shaders
#endif
#endif
