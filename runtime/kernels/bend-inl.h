// SPDX-License-Identifier: MIT
// Angular springs (docs/engine.md): as forces, and solved together along each strand.
#if defined(HAIRLOOM_RUNTIME_BEND_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HAIRLOOM_RUNTIME_BEND_INL_H
#undef HAIRLOOM_RUNTIME_BEND_INL_H
#else
#define HAIRLOOM_RUNTIME_BEND_INL_H
#endif

#include <cmath>

#include "hwy/highway.h"
#include "runtime/kernels.h"
#include "runtime/kernels/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hairloom::runtime {
namespace HWY_NAMESPACE {

/// Seconds in which curves that lag arrive, and the speed in metres per second above which they wait.
inline constexpr float kLeakTime = 2.0f;
inline constexpr float kLeakSpeed = 0.0015f;

/// Cosine of the turn, 162°, behind which a frame's normal follows from rounding: joints there keep their
/// curves.
inline constexpr float kFold = -0.95f;

/// How a joint knows its rest direction.
enum class Shape {
    straight,  ///< its inner segment goes on
    curved,    ///< by the frame carried along the strand
};

/// s = κ·h²·(t − target) of each joint of a block; those past the last segment are zero.
struct Pulls {
    alignas(64) float x[kScratchPlane], y[kScratchPlane], z[kScratchPlane];
    Planes planes() { return {x, y, z}; }
};

/// A segment's direction: by its rest length, or of unit length.
template <bool kExact>
HWY_INLINE V3 tangentOf(V3 edge, V inverseLength) {
    if constexpr (!kExact) return edge * inverseLength;
    const V squared = dot(edge, edge);
    const auto flat = squared < all(1e-20f);
    const V size = hn::Sqrt(hn::IfThenElse(flat, all(1.0f), squared));
    return edge * hn::IfThenElse(flat, hn::Zero(D()), all(1.0f) / size);
}

/// The frame of a segment, carried root to tip: that of the one before, turned by the shortest arc (Melax
/// 2000) that takes one direction to the other (Eq. 4). Its tangent is the segment's, so one normal is all
/// there is to carry: the arc from a to b takes a normal u of a to u − (b·u)/(1 + a·b) · (a + b), which stays
/// bounded at 180°.
HWY_INLINE V3 carryNormal(V3 normal, V3 from, V3 to) {
    const V flat = hn::Max(all(1.0f) + dot(from, to), all(1e-6f));
    return normal - (from + to) * (dot(to, normal) / flat);
}

/// A vector given in a segment's frame.
HWY_INLINE V3 fromFrame(V3 tangent, V3 normal, V3 local) {
    return tangent * local.x + normal * local.y + cross(tangent, normal) * local.z;
}

/// The directions and the normal that the root carries, before the first segment.
template <bool kFrames>
HWY_INLINE void startFrames(const BlockView& block, const LaneFrame& lanes, std::size_t lane, V3& tangent,
                            V3& normal) {
    const V4 root = load4(lanes.rotation, lane);
    tangent = rotate(root, load3(block.rest, lane) * hn::Load(D(), block.inverseLength + lane));
    if constexpr (kFrames)
        normal = rotate(root, load3(block.target, std::size_t{block.points - 1} * kBlockLanes + lane));
}

/// Pulls of angular springs at `position`.
template <Shape kShape, bool kExact>
void measurePulls(const BlockView& block, const LaneFrame& lanes, Pulls& pulls) {
    constexpr bool kFrames = kShape == Shape::curved;
    alignas(64) float inner[3][kBlockLanes], units[3][kBlockLanes], normals[3][kBlockLanes];
    const std::uint32_t first = block.firstFree - 1;
    for (std::uint32_t lane = 0; lane < kBlockLanes; lane += kWidth) {
        V3 tangent, normal = zero3();
        startFrames<kFrames>(block, lanes, lane, tangent, normal);
        store3(tangent, inner, lane);
        store3(tangent, units, lane);
        store3(normal, normals, lane);
        store3(zero3(), pulls.planes(), std::size_t{block.points - 1} * kBlockLanes + lane);
    }
    for (std::uint32_t j = 0; j + 1 < block.points; ++j) {
        for (std::uint32_t lane = 0; lane < kBlockLanes; lane += kWidth) {
            const std::size_t i = std::size_t{j} * kBlockLanes + lane;
            const V3 edge = load3(block.position, i + kBlockLanes) - load3(block.position, i);
            const V3 tangent = tangentOf<kExact>(edge, hn::Load(D(), block.inverseLength + i));
            if (j >= first) {
                V3 off = tangent - load3(inner, lane);
                if constexpr (kFrames)
                    off = off - fromFrame(load3(units, lane), load3(normals, lane), load3(block.target, i));
                store3(off * hn::Load(D(), block.stiffness + i), pulls.planes(), i);
            }
            if constexpr (kFrames) {
                // Springs may stretch: a frame needs directions of unit length.
                const V3 unit = tangentOf<true>(edge, hn::Load(D(), block.inverseLength + i));
                store3(carryNormal(load3(normals, lane), load3(units, lane), unit), normals, lane);
                store3(unit, units, lane);
            }
            store3(tangent, inner, lane);
        }
    }
}

/// Turns the curves that the joints hold towards those of the frames at `previous`. The pulls leave out what
/// turning a curve does to the frame's own strand, so curves that simply followed would feed energy into
/// curly hair without end. They follow as far as the strand's tank lasts: it holds what earlier turning took
/// out of the springs, so that no energy comes from nowhere (passivity by energy tanks, as Duindam and
/// Stramigioli 2004). While the strand rests, curves that lag creep home.
void followFrames(const BlockView& block, const LaneFrame& lanes, const SubstepContext& context,
                  Pulls& wanted, float* share) {
    const V zero = hn::Zero(D()), one = all(1.0f);
    const std::uint32_t first = block.firstFree - 1, end = block.points - 1;
    alignas(64) float inner[3][kBlockLanes], normals[3][kBlockLanes], gain[kBlockLanes], size[kBlockLanes];
    alignas(64) float known[kBlockLanes];
    for (std::uint32_t lane = 0; lane < kBlockLanes; lane += kWidth) {
        V3 tangent, normal;
        startFrames<true>(block, lanes, lane, tangent, normal);
        store3(tangent, inner, lane);
        store3(normal, normals, lane);
        hn::Store(zero, D(), gain + lane);
        hn::Store(zero, D(), size + lane);
        hn::Store(one, D(), known + lane);
    }
    for (std::uint32_t j = 0; j < end; ++j) {
        for (std::uint32_t lane = 0; lane < kBlockLanes; lane += kWidth) {
            const std::size_t i = std::size_t{j} * kBlockLanes + lane;
            const V3 edge = load3(block.previous, i + kBlockLanes) - load3(block.previous, i);
            const V3 tangent = edge * hn::Load(D(), block.inverseLength + i);
            const V3 before = load3(inner, lane), normal = load3(normals, lane);
            if (j >= first) {
                const V3 held = rotate(load4(lanes.turn, lane), load3(block.curve, i));
                const V3 change =
                    (fromFrame(before, normal, load3(block.target, i)) - held) * hn::Load(D(), known + lane);
                const V3 pull = (tangent - before - held) * hn::Load(D(), block.stiffness + i);
                hn::Store(hn::Load(D(), gain + lane) + dot(pull, change), D(), gain + lane);
                hn::Store(
                    hn::Load(D(), size + lane) + dot(change, change) * hn::Load(D(), block.stiffness + i),
                    D(), size + lane);
                store3(held, block.curve, i);
                store3(change, wanted.planes(), i);
            }
            store3(carryNormal(normal, before, tangent), normals, lane);
            store3(tangent, inner, lane);
            const auto folded = dot(before, tangent) < all(kFold);
            hn::Store(hn::IfThenElse(folded, zero, hn::Load(D(), known + lane)), D(), known + lane);
        }
    }
    const V squared = all(context.h * context.h), slow = all(kLeakSpeed * kLeakSpeed);
    const V mostLeak = all(std::fmin(context.h / kLeakTime, 1.0f));
    for (std::uint32_t lane = 0; lane < kBlockLanes; lane += kWidth) {
        const V tank = hn::Load(D(), block.tank + lane);
        const auto fresh = tank < zero;
        const V saved = hn::Max(tank, zero) * squared;
        const V d = hn::Load(D(), gain + lane), s = hn::Load(D(), size + lane);
        // Turning by the share α changes the energy by ½ α² s − α d.
        const V most = (d + hn::Sqrt(d * d + (s + s) * saved)) / hn::Max(s, all(1e-30f));
        const V leak = mostLeak * hn::Max(one - hn::Load(D(), block.motion + lane) / slow, zero);
        V part = hn::Max(hn::Min(most, one), leak);
        part = hn::IfThenElse(fresh, one, part);
        const V gained = part * (d - all(0.5f) * part * s) / squared;
        const V kept = hn::Max(hn::Max(tank, zero) + gained, zero) * all(context.velocityShare);
        hn::Store(hn::IfThenElse(fresh, zero, kept), D(), block.tank + lane);
        hn::Store(part, D(), share + lane);
    }
}

/// Pulls of angular springs q of the way from `previous` to `position` farther on than `position`'s start.
template <Shape kShape>
void measureAhead(const BlockView& block, const LaneFrame& lanes, const SubstepContext& context, Pulls& pulls,
                  const float* share) {
    alignas(64) float inner[3][kBlockLanes];
    const V q = all(context.bendRate);
    const std::uint32_t first = block.firstFree - 1, end = block.points - 1;
    for (std::uint32_t lane = 0; lane < kBlockLanes; lane += kWidth) {
        V3 tangent, normal;
        startFrames<false>(block, lanes, lane, tangent, normal);
        store3(tangent, inner, lane);
        store3(zero3(), pulls.planes(), std::size_t{end} * kBlockLanes + lane);
    }
    for (std::uint32_t j = 0; j < end; ++j) {
        for (std::uint32_t lane = 0; lane < kBlockLanes; lane += kWidth) {
            const std::size_t i = std::size_t{j} * kBlockLanes + lane, o = i + kBlockLanes;
            const V3 from = load3(block.previous, i), to = load3(block.previous, o);
            const V3 moved = (load3(block.position, o) - to) - (load3(block.position, i) - from);
            const V3 tangent = ((to - from) + moved * q) * hn::Load(D(), block.inverseLength + i);
            if (j >= first) {
                V3 off = tangent - load3(inner, lane);
                if constexpr (kShape == Shape::curved) {
                    const V3 change = load3(pulls.planes(), i);
                    const V3 curve = load3(block.curve, i) + change * hn::Load(D(), share + lane);
                    store3(curve, block.curve, i);
                    off = off - curve;
                }
                store3(off * hn::Load(D(), block.stiffness + i), pulls.planes(), i);
            }
            store3(tangent, inner, lane);
        }
    }
}

/// The gradient of the energy by segment s, times h²: (s_s − s_{s+1})/l, or the part of it across the segment
/// by its true length.
template <bool kExact>
HWY_INLINE V3 segmentPull(const BlockView& block, Pulls& pulls, std::size_t i) {
    const V3 difference = load3(pulls.planes(), i) - load3(pulls.planes(), i + kBlockLanes);
    const V inverseLength = hn::Load(D(), block.inverseLength + i);
    if constexpr (!kExact) return difference * inverseLength;
    const V3 edge = load3(block.position, i + kBlockLanes) - load3(block.position, i);
    const V3 tangent = tangentOf<true>(edge, inverseLength);
    const V size = hn::Max(dot(edge, tangent), hn::Load(D(), block.length + i) * all(0.1f));
    const V3 across = difference - tangent * dot(difference, tangent);
    return across * (all(1.0f) / hn::Max(size, all(1e-9f)));
}

/// Angular springs as forces.
template <Shape kShape, bool kExact>
void applyAngular(const BlockView& block, LaneFrame& lanes, const SubstepContext&) {
    Pulls pulls;
    measurePulls<kShape, kExact>(block, lanes, pulls);
    for (std::uint32_t lane = 0; lane < kBlockLanes; lane += kWidth) {
        const std::size_t before = std::size_t{block.firstFree - 1} * kBlockLanes + lane;
        V3 inner = segmentPull<kExact>(block, pulls, before);
        for (std::uint32_t p = block.firstFree; p < block.points; ++p) {
            const std::size_t i = std::size_t{p} * kBlockLanes + lane;
            const V3 outer = p + 1 < block.points ? segmentPull<kExact>(block, pulls, i) : zero3();
            const V3 kick = (inner - outer) * hn::Load(D(), block.inverseMass + i);
            store3(load3(block.previous, i) + kick, block.previous, i);
            inner = outer;
        }
    }
}

/// And the tension of the last substep, along the segment at the start of this one.
template <bool kTense>
HWY_INLINE V3 segmentForce(const BlockView& block, Pulls& pulls, std::size_t i) {
    const V3 pull = segmentPull<false>(block, pulls, i);
    if constexpr (!kTense) return pull;
    const V3 edge = load3(block.previous, i + kBlockLanes) - load3(block.previous, i);
    return pull + edge * (hn::Load(D(), block.inverseLength + i) * hn::Load(D(), block.tension + i));
}

/// Solves (M + share·K) δ = −(forces of `pulls`) along each strand with the factors of the block, and calls
/// take(index, δ), tip to root. Of the pulls it leaves nothing.
template <bool kTense, class Take>
HWY_INLINE void solveBend(const BlockView& block, Pulls& pulls, Take&& take) {
    const Planes work = pulls.planes();
    alignas(64) float innerPull[3][kBlockLanes];
    // The slot of joint p − 1 is free once point p has its right side, and keeps it, then δ.
    for (std::uint32_t p = block.firstFree; p < block.points; ++p) {
        for (std::uint32_t lane = 0; lane < kBlockLanes; lane += kWidth) {
            const std::size_t i = std::size_t{p} * kBlockLanes + lane, slot = i - kBlockLanes;
            const V3 inner =
                p == block.firstFree ? segmentForce<kTense>(block, pulls, slot) : load3(innerPull, lane);
            const V3 outer = p + 1 < block.points ? segmentForce<kTense>(block, pulls, i) : zero3();
            V3 right = outer - inner;
            if (p > block.firstFree)
                right = right - load3(work, slot - kBlockLanes) * hn::Load(D(), block.lower1 + i);
            if (p > block.firstFree + 1)
                right = right - load3(work, slot - 2 * kBlockLanes) * hn::Load(D(), block.lower2 + i);
            store3(right, work, slot);
            store3(outer, innerPull, lane);
        }
    }
    for (std::uint32_t p = block.points; p-- > block.firstFree;) {
        for (std::uint32_t lane = 0; lane < kBlockLanes; lane += kWidth) {
            const std::size_t i = std::size_t{p} * kBlockLanes + lane, slot = i - kBlockLanes;
            V3 delta = load3(work, slot) * hn::Load(D(), block.inverseDiagonal + i);
            if (p + 1 < block.points)
                delta =
                    delta - load3(work, slot + kBlockLanes) * hn::Load(D(), block.lower1 + i + kBlockLanes);
            if (p + 2 < block.points)
                delta = delta - load3(work, slot + 2 * kBlockLanes) *
                                    hn::Load(D(), block.lower2 + i + 2 * kBlockLanes);
            store3(delta, work, slot);
            take(i, delta);
        }
    }
}

/// Angular springs after position Verlet: the step of their force through (M + (¼ + q) h² K)⁻¹, stable for
/// any stiffness (docs/engine.md).
template <Shape kShape>
void bendBack(const BlockView& block, LaneFrame& lanes, const SubstepContext& context) {
    Pulls pulls;
    alignas(64) float share[kBlockLanes];
    if constexpr (kShape == Shape::curved) followFrames(block, lanes, context, pulls, share);
    measureAhead<kShape>(block, lanes, context, pulls, share);
    const auto take = [&](std::size_t i, V3 delta) {
        store3(load3(block.position, i) + delta, block.position, i);
    };
    if (block.tension) {
        solveBend<true>(block, pulls, take);
    } else {
        solveBend<false>(block, pulls, take);
    }
}

/// Closes a step of backward Euler whose displacement is `rate`.
HWY_INLINE void finishImplicit(const BlockView& block, std::size_t i, V3 rate) {
    const V3 start = load3(block.start, i);
    store3(start + rate, block.position, i);
    store3(start, block.previous, i);
}

/// Puts clamped points to the end of their way.
HWY_INLINE void finishClamped(const BlockView& block) {
    const std::size_t end = std::size_t{block.firstFree} * kBlockLanes;
    for (std::size_t i = 0; i < end; i += kWidth) {
        const V3 start = load3(block.start, i);
        store3(start, block.previous, i);
        store3(start + load3(block.rate, i), block.position, i);
    }
}

/// Backward Euler without stiff forces: symplectic Euler.
void advanceFree(const BlockView& block, LaneFrame&, const SubstepContext&) {
    finishClamped(block);
    const std::size_t end = std::size_t{block.points} * kBlockLanes;
    for (std::size_t i = std::size_t{block.firstFree} * kBlockLanes; i < end; i += kWidth)
        finishImplicit(block, i, load3(block.position, i) - load3(block.previous, i));
}

/// Backward Euler (Eq. 9) with angular springs: (M + h² K) d = M u + h² f, where u + h² f/M is the
/// displacement that the forces left, so that d = u + h² f/M + δ with (M + h² K) δ = −h² K of it.
void advanceImplicitBend(const BlockView& block, LaneFrame&, const SubstepContext&) {
    Pulls pulls;
    const std::uint32_t first = block.firstFree - 1;
    for (std::uint32_t lane = 0; lane < kBlockLanes; lane += kWidth) {
        V3 inner = zero3();
        for (std::uint32_t j = 0; j + 1 < block.points; ++j) {
            const std::size_t i = std::size_t{j} * kBlockLanes + lane, o = i + kBlockLanes;
            const V3 from = load3(block.position, i) - load3(block.previous, i);
            const V3 to = load3(block.position, o) - load3(block.previous, o);
            const V3 rate = (to - from) * hn::Load(D(), block.inverseLength + i);
            if (j >= first) store3((rate - inner) * hn::Load(D(), block.stiffness + i), pulls.planes(), i);
            inner = rate;
        }
        store3(zero3(), pulls.planes(), std::size_t{block.points - 1} * kBlockLanes + lane);
    }
    finishClamped(block);
    solveBend<false>(block, pulls, [&](std::size_t i, V3 delta) {
        const V3 rate = load3(block.position, i) - load3(block.previous, i);
        finishImplicit(block, i, rate + delta);
    });
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();
#endif
