// SPDX-License-Identifier: MIT
// The stages, compiled once for each instruction set by kernels.cpp. Each walks a block from root to tip and,
// at every point, over the block's lanes: neighbouring vectors are independent and hide each other's latency.

#include <cmath>

#include "hwy/highway.h"
#include "runtime/kernels.h"
#include "runtime/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hairloom::runtime {
namespace HWY_NAMESPACE {

inline V lerp(V a, V b, V t) {
    return a + (b - a) * t;
}

/// Turns the roots to where they are at the end of the substep and takes the clamped points along.
void moveRoots(const BlockView& block, LaneFrame& lanes, const SubstepContext& context) {
    const V t = all(static_cast<float>(context.index + 1) / static_cast<float>(context.count));
    for (std::uint32_t lane = 0; lane < kBlockLanes; lane += kWidth) {
        const V4 from = load4(lanes.rotationFrom, lane);
        V4 to = load4(lanes.rotationTo, lane);
        const V side = from.x * to.x + from.y * to.y + from.z * to.z + from.w * to.w;
        const auto otherHalf = side < all(0.0f);
        to = {hn::IfThenElse(otherHalf, hn::Neg(to.x), to.x), hn::IfThenElse(otherHalf, hn::Neg(to.y), to.y),
              hn::IfThenElse(otherHalf, hn::Neg(to.z), to.z), hn::IfThenElse(otherHalf, hn::Neg(to.w), to.w)};
        const V4 mixed{lerp(from.x, to.x, t), lerp(from.y, to.y, t), lerp(from.z, to.z, t),
                       lerp(from.w, to.w, t)};
        const V norm =
            hn::Sqrt(mixed.x * mixed.x + mixed.y * mixed.y + mixed.z * mixed.z + mixed.w * mixed.w);
        const V inverse = all(1.0f) / norm;
        const V4 now{mixed.x * inverse, mixed.y * inverse, mixed.z * inverse, mixed.w * inverse};
        store4(now, lanes.rotation, lane);

        const V3 step = load3(lanes.rootStep, lane);
        const V zero = hn::Zero(D());
        store3({zero - step.x, zero - step.y, zero - step.z}, block.previous, lane);
        if (block.firstFree > 1 && block.points > 1) {
            const std::size_t i = kBlockLanes + lane;
            store3(load3(block.position, i) - step, block.previous, i);
            store3(rotate(now, load3(block.rest, lane)), block.position, i);
        }
    }
}

void applyGravity(const BlockView& block, LaneFrame&, const SubstepContext& context) {
    const V3 step = all3(context.gravityStep);
    const std::size_t end = std::size_t{block.points} * kBlockLanes;
    for (std::size_t i = std::size_t{block.firstFree} * kBlockLanes; i < end; i += kWidth) {
        store3(load3(block.previous, i) - step, block.previous, i);
    }
}

/// Hair takes on the air's velocity at the rate airDrag · sin of its angle to the tangent (Rünz 2012,
/// Section 3.3).
template <bool kWind>
void applyAir(const BlockView& block, LaneFrame& lanes, const SubstepContext& context) {
    const V share = all(context.dragShare);
    const V tiny = all(1e-30f);
    const float now = static_cast<float>(context.index + 1) / static_cast<float>(context.count);
    for (std::uint32_t lane = 0; lane < kBlockLanes; lane += kWidth) {
        V3 atRoot{}, slope{};
        if constexpr (kWind) {
            const V t = all(now);
            const V3 r0 = load3(lanes.windRoot[0], lane), r1 = load3(lanes.windRoot[1], lane);
            const V3 t0 = load3(lanes.windTip[0], lane), t1 = load3(lanes.windTip[1], lane);
            atRoot = {lerp(r0.x, r1.x, t), lerp(r0.y, r1.y, t), lerp(r0.z, r1.z, t)};
            slope = V3{lerp(t0.x, t1.x, t), lerp(t0.y, t1.y, t), lerp(t0.z, t1.z, t)} - atRoot;
        }
        const float inverseLast = 1.0f / static_cast<float>(block.points - 1);
        V3 parent = load3(block.position, (block.firstFree - 1) * kBlockLanes + lane);
        for (std::uint32_t p = block.firstFree; p < block.points; ++p) {
            const std::size_t i = std::size_t{p} * kBlockLanes + lane;
            const V3 position = load3(block.position, i);
            const V3 previous = load3(block.previous, i);
            V3 flow = previous - position;
            if constexpr (kWind) {
                const V along = all(static_cast<float>(p) * inverseLast);
                flow = flow + atRoot + slope * along;
            }
            const V3 tangent = position - parent;
            const V both = dot(flow, flow) * dot(tangent, tangent);
            const V parallel = dot(flow, tangent);
            const V sineSquared = hn::Max(both - parallel * parallel, hn::Zero(D())) / (both + tiny);
            const V part = share * hn::Sqrt(hn::Min(sineSquared, all(1.0f)));
            store3(previous - flow * part, block.previous, i);
            parent = position;
        }
    }
}

/// Position Verlet (Rünz 2012, Eq. 10), where the displacement relative to the moving root decays with the
/// damping.
void integrate(const BlockView& block, LaneFrame& lanes, const SubstepContext& context) {
    const V share = all(context.velocityShare);
    for (std::uint32_t lane = 0; lane < kBlockLanes; lane += kWidth) {
        const V3 step = load3(lanes.rootStep, lane);
        for (std::uint32_t p = block.firstFree; p < block.points; ++p) {
            const std::size_t i = std::size_t{p} * kBlockLanes + lane;
            const V3 position = load3(block.position, i);
            const V3 moved = position - load3(block.previous, i) - step;
            store3(position - step, block.previous, i);
            store3(position + moved * share, block.position, i);
        }
    }
}

/// Each point goes the share `pull` of the way to its rest place beside its parent (Rünz 2012, Eq. 4 and the
/// cheaper of its two directions), then the frame of reference turns with the segment. Of that move the share
/// `settle` leaves the speed alone: without it each segment would drive the next one at its resonance.
void bendBack(const BlockView& block, LaneFrame& lanes, const SubstepContext&) {
    alignas(64) float carried[4][kBlockLanes];
    for (std::uint32_t lane = 0; lane < kBlockLanes; lane += kWidth)
        store4(load4(lanes.rotation, lane), carried, lane);
    for (std::uint32_t p = block.firstFree; p < block.points; ++p) {
        for (std::uint32_t lane = 0; lane < kBlockLanes; lane += kWidth) {
            const std::size_t i = std::size_t{p} * kBlockLanes + lane;
            const std::size_t s = i - kBlockLanes;
            const V4 frame = load4(carried, lane);
            const V3 target = rotate(frame, load3(block.rest, s));
            const V3 parent = load3(block.position, s);
            const V3 segment = load3(block.position, i) - parent;
            const V3 move = (target - segment) * hn::Load(D(), block.pull + s);
            const V3 bent = segment + move;
            store3(parent + bent, block.position, i);
            store3(load3(block.previous, i) + move * hn::Load(D(), block.settle + s), block.previous, i);
            store4(multiply(shortestArc(target, bent), frame), carried, lane);
        }
    }
}

/// Newton steps on all length constraints ½(|e|²/l − l) = 0 of a strand together; the root has infinite mass,
/// all other points the same. The system is tridiagonal and is solved directly (after Goldenthal et al.
/// 2007), so momentum travels along the whole strand in one step. Short segments keep a diagonal of at least
/// ¼: no overshoot.
void holdLength(const BlockView& block, LaneFrame&, const SubstepContext& context) {
    alignas(64) float ux[kMaxPoints * kWidth], uy[kMaxPoints * kWidth], uz[kMaxPoints * kWidth];
    alignas(64) float upper[kMaxPoints * kWidth], right[kMaxPoints * kWidth];
    const Planes u{ux, uy, uz};
    const V half = all(0.5f);
    const V least = all(0.25f);
    const std::uint32_t first = block.firstFree - 1;
    const std::uint32_t end = block.points - 1;
    for (std::uint32_t iteration = 0; iteration < context.lengthIterations; ++iteration) {
        for (std::uint32_t lane = 0; lane < kBlockLanes; lane += kWidth) {
            V3 parent = load3(block.position, std::size_t{first} * kBlockLanes + lane);
            V3 before = zero3();
            V inverse = hn::Zero(D()), rhs = hn::Zero(D());
            for (std::uint32_t s = first; s < end; ++s) {
                const std::size_t i = std::size_t{s} * kBlockLanes + lane;
                const V3 point = load3(block.position, i + kBlockLanes);
                const V rest = hn::Load(D(), block.length + i);
                const V3 edge = point - parent;
                const V3 gradient = edge * hn::Load(D(), block.inverseLength + i);
                const V error = half * (dot(edge, gradient) - rest);
                const V squared = hn::Max(dot(gradient, gradient), least);
                const V coupling = dot(before, gradient);
                const V mass = s == first ? squared : squared + squared;
                const V up = coupling * inverse;
                inverse = all(1.0f) / (mass - coupling * up);
                rhs = (error + coupling * rhs) * inverse;
                const std::size_t k = std::size_t{s} * kWidth;
                hn::Store(up, D(), upper + k);
                hn::Store(rhs, D(), right + k);
                store3(gradient, u, k);
                before = gradient;
                parent = point;
            }
            V3 after = zero3();
            V lambda = hn::Zero(D()), up = hn::Zero(D());
            for (std::uint32_t s = end; s-- > first;) {
                const std::size_t i = std::size_t{s} * kBlockLanes + lane;
                const std::size_t k = std::size_t{s} * kWidth;
                lambda = hn::Load(D(), right + k) + up * lambda;
                const V3 tension = load3(u, k) * lambda;
                store3(load3(block.position, i + kBlockLanes) + (after - tension), block.position,
                       i + kBlockLanes);
                after = tension;
                up = hn::Load(D(), upper + k);
            }
        }
    }
}

/// Impulse with restitution (Rünz 2012, Eq. 20) and Coulomb friction, then the place p_a on the sphere (Eq.
/// 21, to which the centre is added). A point at the very centre leaves it upwards.
inline void respond(const BlockView& block, const SubstepContext& context, std::size_t i, hn::Mask<D> inside,
                    V3 offset, V squared, V3 centre, V reach, V3 centreStep) {
    const V zero = hn::Zero(D()), one = all(1.0f);
    const V distance = hn::Sqrt(squared);
    const auto centred = distance < all(1e-9f);
    const V inverse = one / hn::IfThenElse(centred, one, distance);
    const V3 normal{hn::IfThenElse(centred, zero, offset.x * inverse),
                    hn::IfThenElse(centred, one, offset.y * inverse),
                    hn::IfThenElse(centred, zero, offset.z * inverse)};
    const V3 position = load3(block.position, i);
    const V3 previous = load3(block.previous, i);
    const V3 relative = position - previous - centreStep;
    const V approach = hn::Min(dot(relative, normal), zero);
    const V3 sliding = relative - normal * dot(relative, normal);
    const V impulse = (zero - approach) * all(1.0f + context.restitution);
    const V slidingSpeed = hn::Sqrt(dot(sliding, sliding));
    const V lost = hn::Min(all(context.friction) * impulse / (slidingSpeed + all(1e-20f)), one);
    const V3 after = relative + normal * impulse - sliding * lost;
    const V3 placed = centre + normal * reach;
    const V3 before = placed - (after + centreStep);
    store3(select(inside, placed, position), block.position, i);
    store3(select(inside, before, previous), block.previous, i);
}

/// Pushes points out of spheres (Rünz 2012, Eq. 14), pearls growing linearly to the tip. Spheres that do not
/// meet the block's bounding box are skipped.
void collide(const BlockView& block, LaneFrame& lanes, const SubstepContext& context) {
    const float step = static_cast<float>(context.index + 1);
    const Box box = boundsOf(block, lanes, step);
    const float largestPearl = std::fmax(context.pearlRoot, context.pearlTip);
    const float pearlSlope = (context.pearlTip - context.pearlRoot) / static_cast<float>(block.points - 1);
    for (const MovingSphere& sphere : context.spheres) {
        const Float3 centre_ws = sphere.from_ws + sphere.step * step;
        if (!box.meets(centre_ws, sphere.radius + largestPearl)) continue;
        const V3 centreStep = all3(sphere.step);
        for (std::uint32_t lane = 0; lane < kBlockLanes; lane += kWidth) {
            const V3 root = load3(lanes.root, lane) + load3(lanes.rootStep, lane) * all(step);
            const V3 centre = all3(centre_ws) - root;
            for (std::uint32_t p = block.firstFree; p < block.points; ++p) {
                const std::size_t i = std::size_t{p} * kBlockLanes + lane;
                const V reach = all(sphere.radius + context.pearlRoot + pearlSlope * static_cast<float>(p));
                const V3 offset = load3(block.position, i) - centre;
                const V squared = dot(offset, offset);
                const auto inside = squared < reach * reach;
                if (HWY_LIKELY(hn::AllFalse(D(), inside))) continue;
                respond(block, context, i, inside, offset, squared, centre, reach, centreStep);
            }
        }
    }
}

/// Root to tip, brings segments back to between (1 − ε) and (1 + ε) of their length (Provot 1995, both ways).
/// The move counts as velocity only where that slows the point relative to its root: it never adds energy.
void limitExtension(const BlockView& block, LaneFrame& lanes, const SubstepContext& context) {
    const V longest = all(1.0f + context.maximalExtension);
    const V shortest = all(1.0f - context.maximalExtension);
    const V tiny = all(1e-12f), one = all(1.0f);
    for (std::uint32_t lane = 0; lane < kBlockLanes; lane += kWidth) {
        const V3 step = load3(lanes.rootStep, lane);
        V3 parent = load3(block.position, std::size_t{block.firstFree - 1} * kBlockLanes + lane);
        for (std::uint32_t p = block.firstFree; p < block.points; ++p) {
            const std::size_t i = std::size_t{p} * kBlockLanes + lane;
            const V3 position = load3(block.position, i);
            const V3 edge = position - parent;
            const V rest = hn::Load(D(), block.length + (i - kBlockLanes));
            const V low = rest * shortest, high = rest * longest;
            const V squared = dot(edge, edge);
            const auto wrong = hn::Or(squared > high * high, squared < low * low);
            parent = position;
            if (HWY_LIKELY(hn::AllFalse(D(), wrong))) continue;
            const V size = hn::Sqrt(squared);
            const auto collapsed = size < tiny;
            const V bounded = hn::Min(hn::Max(size, low), high);
            const V scale = bounded / hn::IfThenElse(collapsed, one, size);
            const V zero = hn::Zero(D());
            const V3 fixed{hn::IfThenElse(collapsed, zero, edge.x * scale),
                           hn::IfThenElse(collapsed, zero - bounded, edge.y * scale),
                           hn::IfThenElse(collapsed, zero, edge.z * scale)};
            const V3 move = select(wrong, fixed - edge, zero3());
            const V3 previous = load3(block.previous, i);
            const V3 moving = position - previous - step;
            const V3 slowed = moving + move;
            const auto faster = dot(slowed, slowed) > dot(moving, moving);
            parent = position + move;
            store3(parent, block.position, i);
            store3(select(faster, previous + move, previous), block.previous, i);
        }
    }
}

void rescale(const BlockView& block, float factor) {
    const V share = all(factor);
    const std::size_t end = std::size_t{block.points} * kBlockLanes;
    for (std::size_t i = 0; i < end; i += kWidth) {
        const V3 position = load3(block.position, i);
        store3(position - (position - load3(block.previous, i)) * share, block.previous, i);
    }
}

/// Displacement of the air per substep at one place: the mean flow and its gusts.
inline V3 windAt(const Wind& wind, const float* phases, V3 place_ws) {
    V3 sum = all3(wind.mean);
    for (std::uint32_t m = 0; m < kWindModes; ++m) {
        const V turns = dot(place_ws, all3(wind.modes[m].waveVector)) + all(phases[m]);
        sum = sum + all3(wind.modes[m].amplitude) * sineOfTurns(turns);
    }
    return sum;
}

void sampleWind(const BlockView& block, LaneFrame& lanes, float h, const Wind& wind, const float* from,
                const float* to) {
    const std::size_t tip = std::size_t{block.points - 1} * kBlockLanes;
    for (std::uint32_t lane = 0; lane < kBlockLanes; lane += kWidth) {
        const V3 root = load3(lanes.root, lane);
        const V3 end = root + load3(block.position, tip + lane);
        const V substep = all(h);
        store3(windAt(wind, from, root) * substep, lanes.windRoot[0], lane);
        store3(windAt(wind, to, root) * substep, lanes.windRoot[1], lane);
        store3(windAt(wind, from, end) * substep, lanes.windTip[0], lane);
        store3(windAt(wind, to, end) * substep, lanes.windTip[1], lane);
    }
}

const Kernels& kernelsOfTarget() {
    static const Kernels kTable{{moveRoots, applyGravity, applyAir<false>, applyAir<true>, integrate,
                                 bendBack, holdLength, collide, limitExtension},
                                rescale,
                                sampleWind,
                                hwy::TargetName(HWY_TARGET)};
    return kTable;
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();
