// SPDX-License-Identifier: MIT
// The velocity of the air.
#if defined(HAIRLOOM_RUNTIME_WIND_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HAIRLOOM_RUNTIME_WIND_INL_H
#undef HAIRLOOM_RUNTIME_WIND_INL_H
#else
#define HAIRLOOM_RUNTIME_WIND_INL_H
#endif

#include <cmath>
#include <cstdint>

#include "engine/kernels.h"
#include "engine/lanes-inl.h"
#include "engine/spheres-inl.h"
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

/// x^(−1/3), x > 0: a guess from the exponent, and Newton's steps for y⁻³ = x.
HWY_INLINE V inverseCubeRoot(V x) {
    using Ints = hn::RebindToSigned<D>;
    const V third = hn::ConvertTo(D(), hn::BitCast(Ints(), x)) * all(-1.0f / 3.0f);
    // A third of the exponent's bias four times over.
    V y = hn::BitCast(D(), hn::ConvertTo(Ints(), third + all(1.4205e9f)));
    for (int i = 0; i < 3; ++i) y = y * (all(4.0f) - x * y * y * y) * all(1.0f / 3.0f);
    return y;
}

/// What a sphere leaves of the air's velocity at `to` from its centre, in a wind along `along` (of unit
/// length). Outside: potential flow, U (1 + q/2) − 3/2 q (U·n) n with q = (R/r)³, which enters the sphere
/// nowhere. Behind: a turbulent wake (Tennekes, Lumley 1972, Section 4.2) whose deficit decays with the
/// distance s, in radii, as s^(−2/3), with the profile d (1 + ρ²/w²)⁻². Its width follows from the drag,
/// C_d = 0.47, which it carries away at every distance: w² (d − d²/3) = C_d/2.
HWY_INLINE V3 airPastSphere(V3 air, V3 to, V radius, V3 along) {
    const V one = all(1.0f), zero = hn::Zero(D());
    const V inverseRadius = one / radius;
    const V3 at = to * inverseRadius;
    const V squared = hn::Max(dot(at, at), all(1e-12f));
    const V inverse = one / hn::Sqrt(squared);
    const V near = hn::Min(inverse, one), q = near * near * near;
    const V3 normal = at * inverse;
    const V3 around = air * (one + all(0.5f) * q) - normal * (all(1.5f) * q * dot(air, normal));
    const V s = dot(at, along);
    const V nearWake = all(3.0f);  // radii in which the air stands behind the sphere
    const V root = inverseCubeRoot(hn::Max(s, nearWake) / nearWake);
    const V deficit = root * root;
    const V width = all(0.235f) / (deficit - deficit * deficit * all(1.0f / 3.0f));
    const V profile = one + hn::Max(dot(at, at) - s * s, zero) / width;
    const V behind = hn::Min(hn::Max(s, zero), one);
    const V begins = behind * behind * (all(3.0f) - behind - behind);
    return around * (one - begins * deficit / (profile * profile));
}

/// windAt() as spheres leave it: each acts on what those before it left, as if it were at rest. `steps`:
/// substeps since the frame's start.
HWY_INLINE V3 shelteredWindAt(const Wind& wind, const float* phases, V3 position_ws,
                              const SubstepContext& context, float steps) {
    const V3 open = windAt(wind, phases, position_ws);
    if (HWY_LIKELY(!(context.windShelter > 0.0f))) return open;
    const float speed = length(wind.mean);
    if (!(speed > 0.0f)) return open;
    const V3 along = all3(wind.mean * (1.0f / speed));
    V3 air = open;
    for (const MovingSphere& sphere : context.shelters) {
        if (sphere.radius < 1e-6f) continue;  // no air stands behind a point
        const V3 centre = all3(sphere.from_ws + sphere.step * steps);
        air = airPastSphere(air, position_ws - centre, all(sphere.radius), along);
    }
    for (const MovingCapsule& capsule : context.capsules) {
        const RodCapsuleSphere sphere = rodCapsuleNearest(capsuleOf(capsule, steps), position_ws);
        air = airPastSphere(air, position_ws - sphere.centre, hn::Max(sphere.radius, all(1e-6f)), along);
    }
    return open + (air - open) * all(context.windShelter);
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();
#endif
