// SPDX-License-Identifier: MIT
// Collision with spheres (Rünz 2012, Section 3.4).
#if HAIR_SPHERES

#include "spheres.hlsli"

// Where spheres overlap, the places that respond to one are settled among this many: those of the engine's set.
#define SPHERE_SET 64
// Share of a sphere's radius that a point may move in one substep unseen by the test for continuous collision.
#define UNSWEPT_SHARE 0.25

// Spheres that are looked at together, so that they are fetched while others are worked on; the last stands for
// those past the end.
#if HAIR_STORAGE == 3
// More would cost registers, and side by side run fewer groups.
#define SPHERES_AT_ONCE 2
#else
#define SPHERES_AT_ONCE 5
#endif
#define EACH_SPHERE(first, end) \
    [loop] for (uint sphereRow = first; sphereRow < end; sphereRow += SPHERES_AT_ONCE) \
        [unroll] for (uint sphereAt = 0; sphereAt < SPHERES_AT_ONCE; ++sphereAt)
#define SPHERE_BEFORE(end) min(sphereRow + sphereAt, end - 1)

/// What a point touches.
struct Contact {
    float3 centre;  // relative to the root
    float3 step;    // the sphere's displacement in one substep
    float reach;    // of the sphere and of the strand
    float3 from;    // from the centre into the direction in which the point is placed; any length
};

/// Places a point on its sphere (Eq. 21, to which the centre is added) and gives it the impulse with
/// restitution (Eq. 20) and Coulomb friction, both relative to the sphere. `at` and `before` are its position now
/// and a substep ago.
void respond(Contact contact, inout float3 at, inout float3 before) {
    const Direction direction = directionOf(contact.from);
    const float3 normal = direction.unit;
    const float3 relative = at - before - contact.step;
    const float along = dot(relative, normal);
    const float3 sliding = relative - normal * along;
    const float approach = max(-along, 0.0);
    const float bounce = 1.0 + gFrame.substep.restitution;
    const float frictionRate = gFrame.substep.friction * bounce * rsqrt(dot(sliding, sliding) + 1e-30);
    const float lost = min(frictionRate * approach, 1.0);
    // Friction also takes back what the point has slid while inside, or sticking hair would creep.
    const float depth = max(contact.reach - direction.size, 0.0);
    const float slid = min(frictionRate * min(depth, approach), 1.0);
    const float3 after = relative + normal * (approach * bounce) - sliding * lost;
    at = contact.centre + normal * contact.reach - sliding * slid;
    before = at - (after + contact.step);
}

/// From the centre to the position p_b where the way of this substep entered the sphere: the s < 0 that solves
/// |p + s·v − c| = reach. Where that way does not begin outside, or enters flatter than 1 in 20, it is p_a.
float3 backAlong(float3 offset, float3 relative, float squared, float reach) {
    const float a = dot(relative, relative);
    const float b = dot(relative, offset);
    const float c = squared - reach * reach;
    const float discriminant = b * b - a * c;
    const float root = sqrt(max(discriminant, 0.0));
    // Of the two forms of the root the one whose sum does not cancel.
    const float above = b < 0.0 ? c : -(b + root);
    const float below = b < 0.0 ? root - b : a;
    const bool moving = a > 1e-20;
    const float s = above / (moving ? below : 1.0);
    const bool steep = discriminant > a * reach * reach * 0.0025;
    return moving && steep && s >= -1.0 && s <= 0.0 ? offset + relative * s : offset;
}

/// The point of the circle in which the contact's sphere and another one meet that is nearest to `at`, from
/// the other's centre; `meet` is false where they do not meet in a circle.
float3 nearestOfCircle(float3 at, Contact contact, float3 centre, float reach, out bool meet) {
    const float3 axis = contact.centre - centre;
    const float squared = dot(axis, axis);
    const float share = 0.5 * (squared + reach * reach - contact.reach * contact.reach) / max(squared, 1e-12);
    const float circle = reach * reach - share * share * squared;
    const float3 offset = at - centre;
    const float3 across = offset - axis * (dot(offset, axis) / max(squared, 1e-12));
    const float acrossSquared = dot(across, across);
    meet = squared > 1e-12 && circle > 0.0 && acrossSquared > 1e-12;
    return axis * share + across * (sqrt(max(circle, 0.0)) * rsqrt(acrossSquared + 1e-30));
}

/// A point that left one sphere into others of a union goes to the circle that its last sphere and the one in
/// which it is deepest have in common, until it is free.
void settle(Contact contact, uint first, uint end, float collisionRadius, float3 root, float step, inout float3 at,
            inout float3 before) {
    bool inside = true;
    [loop] for (uint k = 0; k < 16 && inside; ++k) {
        float deepest = 0.0;
        Contact next = contact;
        EACH_SPHERE(first, end) {
            const uint j = SPHERE_BEFORE(end);
            const float3 centre = sphereCentre(j, step) - root;
            const float reach = gSpheres[j].from.w + collisionRadius;
            const float3 offset = at - centre;
            // About twice the reach times the depth, but for the depth that rounding leaves.
            const float depth = reach * (reach - 4e-6) - dot(offset, offset);
            if (depth > deepest) {
                deepest = depth;
                next.centre = centre;
                next.step = gSpheres[j].step.xyz;
                next.reach = reach;
            }
        }
        inside = deepest > 0.0;
        if (inside) {
            bool meet;
            const float3 onCircle = nearestOfCircle(at, contact, next.centre, next.reach, meet);
            next.from = meet ? onCircle : at - next.centre;
            contact = next;
            respond(contact, at, before);
        }
    }
}

#if HAIR_SPHERES != 1
/// Of spheres of several sets: a point that one set leaves in a sphere of another goes out as settle() has it, among
/// all of them. Whether it was in one.
bool settleSets(uint p, float3 root, float step, inout float3 at, inout float3 before) {
    Contact none;
    none.centre = float3(1e6, 0, 0);  // no circle is common with what is so far away: the first way out is the shortest
    none.step = none.from = float3(0, 0, 0);
    none.reach = 0.0;
    const float3 began = at;
    settle(none, 0, gFrame.sphereCount, collisionRadiusAt(p), root, step, at, before);
    return any(began != at);
}
#endif

/// Whether a position lies in one of the spheres but `own`.
bool insideOthers(float3 at, uint own, uint first, uint end, float collisionRadius, float3 root, float step) {
    bool inside = false;
    EACH_SPHERE(first, end) {
        const uint j = SPHERE_BEFORE(end);
        const float3 offset = at - (sphereCentre(j, step) - root);
        const float reach = gSpheres[j].from.w + collisionRadius;
        inside = inside || (j != own && dot(offset, offset) < reach * reach);
    }
    return inside;
}

/// What one substep of collisions does to a point.
struct Touch {
    float3 at, before;  // its position now and a substep ago
    bool touched;
    bool asks;          // for the position of the point before it, which is not known
};

/// One point against the spheres first … end − 1 of a set that it or its strand is near to by `near`. Only spheres in
/// which it is at the start count: one that another pushes it into is settled. `inner` is the position of the point
/// before it.
Touch touchSpheres(bool backward, uint p, float3 at, float3 before, float3 inner, bool knowsInner, uint first, uint end,
                   uint2 near, float3 root, float step) {
    const float collisionRadius = collisionRadiusAt(p);
    const float3 began = at;
    Touch result;
    result.touched = result.asks = false;
    const uint count = countbits(near.x) + countbits(near.y);
    [loop] for (uint turn = 0; turn < count; ++turn) {
        const bool low = near.x != 0u;
        const uint bit = firstbitlow(low ? near.x : near.y);
        if (low) {
            near.x &= near.x - 1u;
        } else {
            near.y &= near.y - 1u;
        }
        const uint k = first + bit + (low ? 0u : 32u);
        Contact contact;
        contact.centre = sphereCentre(k, step) - root;
        contact.reach = gSpheres[k].from.w + collisionRadius;
        const float3 offset = at - contact.centre, offsetBegan = began - contact.centre;
        const float squared = dot(offset, offset), reachSquared = contact.reach * contact.reach;
        if (squared < reachSquared && dot(offsetBegan, offsetBegan) < reachSquared) {
            contact.step = gSpheres[k].step.xyz;
            contact.from = offset;
            if (backward) contact.from = backAlong(offset, at - before - contact.step, squared, contact.reach);
            if (gFrame.lengthIterations > 0u && squared < reachSquared * (HAIRLOOM_DEEP_IN_SPHERE * HAIRLOOM_DEEP_IN_SPHERE)) {
                result.asks = result.asks || !knowsInner;
                contact.from = acrossStrand(offset, at - inner);
            }
            respond(contact, at, before);
            result.touched = true;
            if (insideOthers(at, k, first, end, collisionRadius, root, step))
                settle(contact, first, end, collisionRadius, root, step, at, before);
        }
    }
    result.at = at;
    result.before = before;
    return result;
}

#if HAIR_STORAGE == 3
#include "lanes_collide.hlsli"
#else
#include "threads_collide.hlsli"
#endif
void stageCollision() { collide(false); }
void stageCollisionBack() { collide(true); }

/// Catches a fast point where it first enters a sphere that it has passed, or passed the middle of, by the end
/// of the substep. Runs before `collide`.
void collideContinuously(uint p, float3 root, float step) {
    float3 at = position(p), before = previous(p);
    const float3 moved = at - before;
    if (dot(moved, moved) >= gFrame.substep.slowestSwept * gFrame.substep.slowestSwept) {
        const float collisionRadius = collisionRadiusAt(pointOf(p));
        float earliest = 0.0;
        uint met = 0u;
        EACH_SPHERE(0, gFrame.sphereCount) {
            const uint k = SPHERE_BEFORE(gFrame.sphereCount);
            const float reach = gSpheres[k].from.w + collisionRadius;
            const float3 relative = moved - gSpheres[k].step.xyz;
            const float3 offset = at - (sphereCentre(k, step) - root);
            const float a = dot(relative, relative), b = dot(relative, offset);
            const float discriminant = b * b - a * (dot(offset, offset) - reach * reach);
            const float fast = UNSWEPT_SHARE * reach;
            if (a > fast * fast && b > 0.0 && discriminant > 0.0) {
                const float s = -(b + sqrt(discriminant)) / a;
                if (s >= -1.0 && s < earliest) {
                    earliest = s;
                    met = k;
                }
            }
        }
        if (earliest < 0.0) {
            Contact contact;
            contact.centre = sphereCentre(met, step) - root;
            contact.step = gSpheres[met].step.xyz;
            contact.reach = gSpheres[met].from.w + collisionRadius;
            contact.from = at - contact.centre + (moved - contact.step) * earliest;
            respond(contact, at, before);
            setPosition(p, at);
            setPrevious(p, before);
        }
    }
}
void stageContinuousCollision() {
    const float step = float(gSubstep + 1);
    const float3 root = gRoot + gRootDisplacement * step;
#if HAIR_STORAGE == 3
    // Mostly none of the thread's points is fast.
    float fastest = 0.0;
    EACH_OWN_POINT(k) {
        const float3 moved = gPosition[k] - gPrevious[k];
        fastest = max(fastest, dot(moved, moved));
    }
    if (fastest < gFrame.substep.slowestSwept * gFrame.substep.slowestSwept) return;
#endif
    FREE_POINTS(p) collideContinuously(p, root, step);
}

/// Penalty force: a spring of frequency penaltyFrequency from the point to its p_a on each sphere that it is
/// in. Positions are still those of the substep's start.
void stagePenalty() {
    const float step = float(gSubstep);
    const float3 root = gRoot + gRootDisplacement * step;
    FREE_POINTS(p) {
        const float collisionRadius = collisionRadiusAt(pointOf(p));
        const float3 at = position(p);
        float3 push = float3(0, 0, 0);
        [loop] for (uint k = 0; k < gFrame.sphereCount; ++k) {
            const float reach = gSpheres[k].from.w + collisionRadius;
            const float3 offset = at - (sphereCentre(k, step) - root);
            if (dot(offset, offset) < reach * reach) {
                const Direction direction = directionOf(offset);
                push += direction.unit * (max(reach - direction.size, 0.0) * gFrame.substep.penaltyStep);
            }
        }
        setPrevious(p, previous(p) - push);
    }
}
#endif
