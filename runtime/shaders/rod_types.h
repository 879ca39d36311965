// SPDX-License-Identifier: MIT
// What the kernel of rods is told each frame besides SimulationConstants. Metres, seconds, world space.
#ifndef HAIRLOOM_ROD_TYPES_H
#define HAIRLOOM_ROD_TYPES_H
#include "simulation_types.h"

#ifdef __cplusplus
#include <cstddef>
namespace hairloom::shaders {
#endif

/// In RodView::turn and energy: nothing is known of the substep before.
#define HAIRLOOM_ROD_NO_STEP 1e9
#define HAIRLOOM_ROD_NO_ENERGY 1e30
/// Planes of a point in the buffer of rods, as RodView has them; two rows of a strand follow them.
#define HAIRLOOM_ROD_STATE_PLANES 23
/// Planes of a point that a substep works in, and those of contacts behind them.
#define HAIRLOOM_ROD_WORK_PLANES 49
#define HAIRLOOM_ROD_CONTACT_PLANES 15

/// Strands were no rods before, and go on as rods through their points.
#define HAIRLOOM_RODS_FRESH 1
/// Settings have changed what energy rods have: what they had tells nothing of what they may have.
#define HAIRLOOM_RODS_OF_OTHER_ENERGY 2

/// What the settings make of a substep of rods, for the CPU's kernel and the GPU's alike
/// (rodNumbersOf() in models/rods/rod_model.cpp fills it).
struct RodNumbers {
    float rootDamping;      ///< 1/s
    float bendDampingTime;  ///< seconds
    float twist;            ///< (GJ − EI)/EI, of the stiffer bend; 0 where nothing twists
    float flat;             ///< (EI₂ − EI)/EI, of the softer bend; 0 of a round section
};

struct RodConstants {
    float4 gravity;  ///< m/s²; w: drag of the air, 1/s, 0 without air
    RodNumbers numbers;
    float stepRatio;    ///< the first substep over the one before it
    uint points;        ///< that a strand of the batch may have
    uint sweeps;        ///< not 0: spheres are met where fast points come in
    uint conservative;  ///< not 0: nothing but motion of roots and spheres adds energy; 2: nor do spheres
    uint fresh;         ///< HAIRLOOM_RODS_FRESH, HAIRLOOM_RODS_OF_OTHER_ENERGY or 0
    uint capsules;      ///< two of gSpheres for each, behind the spheres
    uint unused0, unused1;
    float4 windTurns[HAIRLOOM_WIND_MODES];  ///< x: turns of a wave in a substep
};

#ifdef __cplusplus
static_assert(sizeof(RodNumbers) % 16 == 0 && offsetof(RodConstants, numbers) == 16);
static_assert(offsetof(RodConstants, windTurns) == 48 + sizeof(RodNumbers));
static_assert(sizeof(RodConstants) == 48 + sizeof(RodNumbers) + 16 * HAIRLOOM_WIND_MODES);
}  // namespace hairloom::shaders
#endif
#endif
