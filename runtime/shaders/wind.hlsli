// SPDX-License-Identifier: MIT
// The wind. Whoever includes this has float windPhase(uint m, uint moment): turns of a wave at a moment.

#define WIND_UNIFORM 0
#define WIND_GUSTING 1

/// sin(2π · turns) to 0.1 %: a parabola, refined once by its own square.
float sineOfTurns(float turns) {
    const float part = turns - round(turns);
    const float parabola = 16.0 * part * (0.5 - abs(part));
    return 0.775 * parabola + 0.225 * parabola * abs(parabola);
}

/// Velocity of the air at one position.
float3 windAt(float3 position_ws, uint moment) {
    const float3 mean = gFrame.wind.xyz;
    if (gFrame.windKind == WIND_UNIFORM) return mean;
    float waves = 0.0;
    float3 eddies = float3(0, 0, 0);
    [loop] for (uint m = 0; m < HAIRLOOM_WIND_MODES; ++m) {
        const float wave = sineOfTurns(dot(position_ws, gFrame.windWaves[m].xyz) + windPhase(m, moment));
        waves += wave;
        eddies += gFrame.windAmplitudes[m].xyz * wave;
    }
    if (gFrame.windKind != WIND_GUSTING) return mean + eddies;
    // The sum of waves has the variance of their number / 2; a sine of it, a quarter turn for its deviation,
    // keeps it smooth and within ±1.
    const float strength = sineOfTurns(waves * (0.25 * sqrt(2.0 / float(HAIRLOOM_WIND_MODES))));
    return mean * (1.0 + strength * gFrame.wind.w);
}
