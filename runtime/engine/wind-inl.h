// SPDX-License-Identifier: MIT
// The velocity of the air.
#if defined(HAIRLOOM_RUNTIME_WIND_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HAIRLOOM_RUNTIME_WIND_INL_H
#undef HAIRLOOM_RUNTIME_WIND_INL_H
#else
#define HAIRLOOM_RUNTIME_WIND_INL_H
#endif

#include <cmath>

#include "engine/kernels.h"
#include "engine/lanes-inl.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace hairloom::runtime {
namespace HWY_NAMESPACE {

/// Velocity of the air at one position: the mean flow and its gusts or eddies.
HWY_INLINE V3 windAt(const Wind& wind, const float* phases, V3 position_ws) {
    const V3 mean = all3(wind.mean);
    if (wind.kind == WindKind::uniform) return mean;
    V waves = hn::Zero(D());
    V3 eddies = zero3();
    for (std::uint32_t m = 0; m < kWindModes; ++m) {
        const V wave = sineOfTurns(dot(position_ws, all3(wind.modes[m].waveVector)) + all(phases[m]));
        waves = waves + wave;
        eddies = eddies + all3(wind.modes[m].amplitude) * wave;
    }
    if (wind.kind != WindKind::gusting) return mean + eddies;
    // The sum of waves has the variance of kWindModes / 2; a sine of it, a quarter turn for its deviation,
    // keeps it smooth and within ±1.
    const V strength = sineOfTurns(waves * all(0.25f * std::sqrt(2.0f / static_cast<float>(kWindModes))));
    return mean * (all(1.0f) + strength * all(wind.strength));
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();
#endif
