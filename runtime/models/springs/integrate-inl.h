// SPDX-License-Identifier: MIT
// Integrators other than position Verlet (docs/engine.md).
#if defined(HAIRLOOM_RUNTIME_INTEGRATE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HAIRLOOM_RUNTIME_INTEGRATE_INL_H
#undef HAIRLOOM_RUNTIME_INTEGRATE_INL_H
#else
#define HAIRLOOM_RUNTIME_INTEGRATE_INL_H
#endif

#include "engine/lanes-inl.h"
#include "hwy/highway.h"
#include "models/springs/spring_block.h"

HWY_BEFORE_NAMESPACE();
namespace hairloom::runtime {
namespace HWY_NAMESPACE {

/// Calls visit(index, point) for every point of the block, clamped ones too.
template <class Visit>
HWY_INLINE void forEachPoint(const SpringBlock& block, Visit&& visit) {
    for (std::uint32_t p = 0; p < block.points; ++p) {
        for (std::uint32_t lane = 0; lane < block.lanes; lane += kWidth)
            visit(std::size_t{p} * kBlockLanes + lane, p);
    }
}

/// The next evaluation of forces is at `position`, with the displacement `stepDisplacement` for velocity.
HWY_INLINE void setEvaluationState(const SpringBlock& block, std::size_t i, V3 position,
                                   V3 stepDisplacement) {
    store3(position, block.position, i);
    store3(position - stepDisplacement, block.previous, i);
}

/// What the forces have added since setEvaluationState().
HWY_INLINE V3 takeKick(const SpringBlock& block, std::size_t i, std::uint32_t p, V3 stepDisplacement) {
    if (p < block.firstFree) return zero3();
    return load3(block.position, i) - load3(block.previous, i) - stepDisplacement;
}

/// Keeps where the substep starts, relative to the root at its end, and the displacement of the last one;
/// that of a clamped point is its displacement in this substep. Forces are evaluated after `kHalves`/2 of it.
template <int kHalves>
void openStep(const SpringBlock& block, LaneFrame& lanes, const SubstepContext&) {
    forEachPoint(block, [&](std::size_t i, std::uint32_t p) {
        const V3 position = load3(block.position, i);
        const V3 previous = load3(block.previous, i);
        const V3 stepDisplacement = position - previous;
        const V3 start =
            p < block.firstFree ? previous : position - load3(lanes.rootDisplacement, i % kBlockLanes);
        store3(start, block.start, i);
        store3(stepDisplacement, block.stepDisplacement, i);
        setEvaluationState(block, i, kHalves == 0 ? start : start + stepDisplacement * all(0.5f),
                           stepDisplacement);
    });
}

/// Explicit Euler (Eq. 7): the way of the old velocity.
void advanceEuler(const SpringBlock& block, LaneFrame&, const SubstepContext&) {
    forEachPoint(block, [&](std::size_t i, std::uint32_t p) {
        const V3 stepDisplacement = load3(block.stepDisplacement, i);
        const V3 kick = takeKick(block, i, p, stepDisplacement);
        setEvaluationState(block, i, load3(block.start, i) + stepDisplacement, stepDisplacement + kick);
    });
}

/// Drift-kick-drift: the second half drift after the kick halfway. Forces that read velocities see that of
/// the start: with them the order is one.
void advanceLeapfrog(const SpringBlock& block, LaneFrame&, const SubstepContext&) {
    forEachPoint(block, [&](std::size_t i, std::uint32_t p) {
        const V3 stepDisplacement = load3(block.stepDisplacement, i);
        const V3 after = stepDisplacement + takeKick(block, i, p, stepDisplacement);
        setEvaluationState(block, i, load3(block.start, i) + (stepDisplacement + after) * all(0.5f), after);
    });
}

/// Velocity Verlet (Eq. 12), first half kick and drift.
void driftVerlet(const SpringBlock& block, LaneFrame&, const SubstepContext&) {
    forEachPoint(block, [&](std::size_t i, std::uint32_t p) {
        const V3 stepDisplacement = load3(block.stepDisplacement, i);
        const V3 half = stepDisplacement + takeKick(block, i, p, stepDisplacement) * all(0.5f);
        setEvaluationState(block, i, load3(block.start, i) + half, half);
    });
}

/// Velocity Verlet: the constraints have moved points and changed the half-step velocity. Velocity-dependent
/// forces see the velocity predicted for the end of the step; `start` keeps it.
void setVerletEvaluationState(const SpringBlock& block, LaneFrame&, const SubstepContext&) {
    forEachPoint(block, [&](std::size_t i, std::uint32_t) {
        const V3 position = load3(block.position, i);
        const V3 half = position - load3(block.previous, i);
        const V3 predicted = half + half - load3(block.stepDisplacement, i);
        store3(half, block.stepDisplacement, i);
        store3(predicted, block.start, i);
        setEvaluationState(block, i, position, predicted);
    });
}

/// Velocity Verlet, second half kick.
void kickVerlet(const SpringBlock& block, LaneFrame&, const SubstepContext&) {
    forEachPoint(block, [&](std::size_t i, std::uint32_t p) {
        const V3 kick = takeKick(block, i, p, load3(block.start, i));
        const V3 stepDisplacement = load3(block.stepDisplacement, i) + kick * all(0.5f);
        setEvaluationState(block, i, load3(block.position, i), stepDisplacement);
    });
}

/// Slope k of the classical Runge-Kutta method, 1…4. With A_k what the forces give at slope k, the velocities
/// are u, u + A₁/2, u + A₂/2 and u + A₃, so the positions need only sums of A.
template <int kSlope>
void rk4Stage(const SpringBlock& block, LaneFrame&, const SubstepContext&) {
    forEachPoint(block, [&](std::size_t i, std::uint32_t p) {
        const V half = all(0.5f);
        const V3 start = load3(block.start, i), stepDisplacement = load3(block.stepDisplacement, i);
        V3 here = stepDisplacement;
        if constexpr (kSlope == 2 || kSlope == 3) here = stepDisplacement + load3(block.kick, i) * half;
        if constexpr (kSlope == 4) here = stepDisplacement + load3(block.kick, i);
        const V3 kick = takeKick(block, i, p, here);
        if constexpr (kSlope == 4) {
            const V sixth = all(1.0f / 6.0f);
            const V3 position = start + stepDisplacement + load3(block.sum, i) * sixth;
            const V3 after = stepDisplacement + (load3(block.stepDisplacementSum, i) + kick) * sixth;
            setEvaluationState(block, i, position, after);
        } else {
            V3 sum = kick, stepDisplacementSum = kick;
            if constexpr (kSlope > 1) {
                sum = load3(block.sum, i) + kick;
                stepDisplacementSum = load3(block.stepDisplacementSum, i) + kick + kick;
            }
            store3(kick, block.kick, i);
            store3(sum, block.sum, i);
            store3(stepDisplacementSum, block.stepDisplacementSum, i);
            if constexpr (kSlope == 3) {
                setEvaluationState(block, i, start + here, stepDisplacement + kick);
            } else {
                setEvaluationState(block, i, start + here * half, stepDisplacement + kick * half);
            }
        }
    });
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();
#endif
