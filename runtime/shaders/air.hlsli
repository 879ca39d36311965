// SPDX-License-Identifier: MIT
// External forces: gravity, drag of still air, wind.

void stageGravity() {
    MOVED_POINTS(p) setPrevious(p, previous(p) - gFrame.gravityStep.xyz * freedom(p));
}

/// Hair takes on the air's velocity at the rate airDrag · sin of its angle to the tangent (Rünz 2012, Section
/// 3.3). `atRoot` and `atTip` are the air's way in one substep.
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
#define WIND_UNIFORM 0
#define WIND_GUSTING 1

/// sin(2π · turns) to 0.1 %: a parabola, refined once by its own square.
float sineOfTurns(float turns) {
    const float part = turns - round(turns);
    const float parabola = 16.0 * part * (0.5 - abs(part));
    return 0.775 * parabola + 0.225 * parabola * abs(parabola);
}

/// Velocity of the air at one place at the start (0) or end (1) of the frame.
float3 windAt(float3 place_ws, uint end) {
    const float3 mean = gFrame.wind.xyz;
    if (gFrame.windKind == WIND_UNIFORM) return mean;
    float waves = 0.0;
    float3 eddies = float3(0, 0, 0);
    [loop] for (uint m = 0; m < HAIRLOOM_WIND_MODES; ++m) {
        const float4 amplitude = gFrame.windAmplitudes[m];
        const float4 waveVector = gFrame.windWaves[m];
        const float wave = sineOfTurns(dot(place_ws, waveVector.xyz) + (end == 0 ? amplitude.w : waveVector.w));
        waves += wave;
        eddies += amplitude.xyz * wave;
    }
    if (gFrame.windKind != WIND_GUSTING) return mean + eddies;
    // The sum of waves has the variance of their number / 2; a sine of it, a quarter turn for its deviation,
    // keeps it smooth and within ±1.
    const float strength = sineOfTurns(waves * (0.25 * sqrt(2.0 / float(HAIRLOOM_WIND_MODES))));
    return mean * (1.0 + strength * gFrame.wind.w);
}

#if HAIR_STORAGE == 3
groupshared float4 gWinds[4 * HAIR_STRANDS];  // of each strand at root and tip, at the start and the end
float3 windHere(uint tip, uint end) { return gWinds[4 * gStrand + 2 * end + tip].xyz; }

/// A thread each for both places and both ends.
void sampleWind() {
    exchangePositions();
    const bool atTip = (gThread & 1u) != 0u;
    const float3 place = atTip ? gRoot + loadPoint(POINTS - 1).xyz : gRoot;
    const float3 way = windAt(place, (gThread >> 1) & 1u) * gFrame.h;
    if (gThread < 4) gWinds[4 * gStrand + gThread] = float4(way, 0);
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
