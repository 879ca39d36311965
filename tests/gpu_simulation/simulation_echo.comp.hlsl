// SPDX-License-Identifier: GPL-3.0-or-later
// Writes back what the strand kernels are told, so that a test sees where the shader finds it.
#include "runtime/shaders/simulation_types.h"

cbuffer Frame : register(b0) { SimulationConstants gFrame; };
StructuredBuffer<SphereConstants> gSpheres : register(t0);
RWStructuredBuffer<float4> gResults : register(u0);

[numthreads(1, 1, 1)]
void main() {
    gResults[0] = asfloat(uint4(gFrame.slots, gFrame.substeps, gFrame.sphereCount, gFrame.lengthIterations));
    gResults[1] = asfloat(uint4(gFrame.wakingCount, gFrame.windKind, gFrame.wakeAll, asuint(gFrame.h)));
    gResults[2] = float4(gFrame.dt, gFrame.rescale, gFrame.teleportDistance, gFrame.slowSquared);
    gResults[3] = float4(gFrame.sleepDelay, asfloat(gFrame.groups), gFrame.sphereDisplacement, gFrame.firstShare);
    const SubstepNumbers substep = gFrame.substep;
    gResults[4] = float4(substep.velocityShare, substep.dragShare, substep.springStep, substep.penaltyStep);
    gResults[5] = float4(substep.bendRate, substep.tensionShare, substep.maximalExtension, substep.collisionRadiusAtRoot);
    gResults[6] = float4(substep.collisionRadiusAtTip, substep.friction, substep.restitution, substep.slowestSwept);
    gResults[7] = gFrame.gravityStep;
    gResults[8] = gFrame.originShift;
    gResults[9] = gFrame.wind;
    for (uint m = 0; m < HAIRLOOM_WIND_MODES; ++m) {
        gResults[10 + m] = gFrame.windAmplitudes[m];
        gResults[10 + HAIRLOOM_WIND_MODES + m] = gFrame.windWaves[m];
    }
    gResults[22] = gSpheres[1].from;
    gResults[23] = gSpheres[1].step;
}
