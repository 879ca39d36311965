// SPDX-License-Identifier: MIT
// External forces: gravity, drag of still air, wind.

void stageGravity() {
    MOVED_POINTS(p) setPrevious(p, previous(p) - gFrame.gravityStep.xyz * freedom(p));
}

/// Hair takes on the air's velocity at the rate airDrag · sin of its angle to the tangent (Rünz 2012, Section
/// 3.3). `atRoot` and `atTip` are the air's displacement in one substep.
void takeAir(float3 atRoot, float3 atTip) {
    INNER_POSITIONS
    MOVED_POINTS(p) {
        const float3 here = position(p);
        const float3 before = previous(p);
        const float along = float(pointOf(p)) * (1.0 / float(POINTS - 1));
        const float3 flow = before - here + atRoot + (atTip - atRoot) * along;
        const float3 tangent = here - INNER_POSITION(p);
        const float both = dot(flow, flow) * dot(tangent, tangent);
        const float parallel = dot(flow, tangent);
        const float sineSquared = max(both - parallel * parallel, 0.0) / (both + 1e-30);
        setPrevious(p, before - flow * (gFrame.substep.dragShare * freedom(p) * sqrt(min(sineSquared, 1.0))));
    }
}

void stageDrag() { takeAir(float3(0, 0, 0), float3(0, 0, 0)); }

#if HAIR_WIND
/// At the start (0) or end (1) of the frame.
float windPhase(uint m, uint end) { return end == 0 ? gFrame.windAmplitudes[m].w : gFrame.windWaves[m].w; }
#include "wind.hlsli"

#if HAIR_STORAGE == 3
groupshared float4 gWinds[4 * HAIR_STRANDS];  // of each strand at root and tip, at the start and the end
float3 windHere(uint tip, uint end) { return gWinds[4 * gStrand + 2 * end + tip].xyz; }

/// A thread each for both positions and both ends.
void sampleWind() {
    exchangePositions();
    const bool atTip = (gThread & 1u) != 0u;
    const float3 position_ws = atTip ? gRoot + loadPoint(POINTS - 1).xyz : gRoot;
    const float3 displacement = windAt(position_ws, (gThread >> 1) & 1u) * gFrame.h;
    if (gThread < 4) gWinds[4 * gStrand + gThread] = float4(displacement, 0);
    GroupMemoryBarrierWithGroupSync();
}
#else
static float3 gWinds[4];
float3 windHere(uint tip, uint end) { return gWinds[2 * end + tip]; }

void sampleWind() {
    const float3 tip = gRoot + position(POINTS - 1);
    [unroll] for (uint end = 0; end < 2; ++end) {
        gWinds[2 * end] = windAt(gRoot, end) * gFrame.h;
        gWinds[2 * end + 1] = windAt(tip, end) * gFrame.h;
    }
}
#endif

void stageWind() {
    const float t = float(gSubstep + 1) / float(gFrame.substeps);
    const float3 root = windHere(0, 0), tip = windHere(1, 0);
    takeAir(root + (windHere(0, 1) - root) * t, tip + (windHere(1, 1) - tip) * t);
}
#endif
