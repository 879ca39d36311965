// SPDX-License-Identifier: MIT
// Points against spheres, of a strand spread over threads; threads_collide.hlsli is the same, point after point. Each thread
// keeps a list of the spheres that are near its points' ways, and the points leave theirs side by side.

// Spheres of a set, as bits.
uint2 allOfSet(uint count) {
    return uint2(count >= 32u ? 0xffffffffu : (1u << count) - 1u,
                 count >= 64u ? 0xffffffffu : count > 32u ? (1u << (count - 32u)) - 1u : 0u);
}
#if HAIR_SPHERES == 1
typedef uint SphereBits;
#define NO_SPHERES 0u
SphereBits firstSpheres(uint count) { return allOfSet(count).x; }
SphereBits bitOfSphere(uint k) { return 1u << k; }
bool hasSphere(SphereBits spheres) { return spheres != 0u; }
/// Takes the first one away.
uint takeSphere(inout SphereBits spheres) {
    const uint k = firstbitlow(spheres);
    spheres &= spheres - 1u;
    return k;
}
#else
typedef uint2 SphereBits;
#define NO_SPHERES uint2(0u, 0u)
SphereBits firstSpheres(uint count) { return allOfSet(count); }
SphereBits bitOfSphere(uint k) { return k < 32u ? uint2(1u << k, 0u) : uint2(0u, 1u << (k - 32u)); }
bool hasSphere(SphereBits spheres) { return (spheres.x | spheres.y) != 0u; }
uint takeSphere(inout SphereBits spheres) {
    const bool low = spheres.x != 0u;
    const uint k = low ? firstbitlow(spheres.x) : 32u + firstbitlow(spheres.y);
    spheres = low ? uint2(spheres.x & (spheres.x - 1u), spheres.y) : uint2(0u, spheres.y & (spheres.y - 1u));
    return k;
}
#endif

/// The spheres of a set that a position can lie in while it is nearer than `slack` to where the thread's first point was when the
/// list was made, less what spheres have gone since the start of the frame.
struct NearList {
    SphereBits spheres;
    float3 from_ws;
    float slack;  // metres
};
static NearList gNear;

void startList() {
    gNear.spheres = NO_SPHERES;
    gNear.from_ws = float3(0, 0, 0);
    gNear.slack = -1.0;
}

/// A set of spheres, first … first + count − 1, at the end of a substep.
struct SphereSet {
    uint first, count;
    float3 root;
    float step;
};
float3 centreOf(SphereSet set, uint k) { return sphereCentre(set.first + k, set.step) - set.root; }
float reachOf(SphereSet set, uint k, float collisionRadius) { return gSpheres[set.first + k].from.w + collisionRadius; }

bool listHolds(SphereSet set, float3 position) {
    const float3 offset = position + set.root - gNear.from_ws;
    const float left = gNear.slack - gFrame.sphereDisplacement * set.step;
    return left > 0.0 && dot(offset, offset) < left * left;
}

/// Makes the thread's list anew where it does not hold for one of its points: for ways twice as long as at the speed of now to the
/// end of the frame.
void keepList(SphereSet set) {
    bool hold = gFrame.sphereCount <= SPHERE_SET;
    EACH_OWN_POINT(i) hold = hold && listHolds(set, gPosition[i]);
    if (hold) return;
    const float left = float(gFrame.substeps) - set.step + 1.0;
    const float collisionRadius = max(gFrame.substep.collisionRadiusAtRoot, gFrame.substep.collisionRadiusAtTip);
    float margin = 0.0;
    EACH_OWN_POINT(j) {
        const float3 moved = gPosition[j] - gPrevious[j], apart = gPosition[j] - gPosition[0];
        margin = max(margin, 2.0 * sqrt(dot(moved, moved)) * left + sqrt(dot(apart, apart)));
    }
    margin += gFrame.sphereDisplacement * left + 1e-3;
    gNear.spheres = NO_SPHERES;
    gNear.from_ws = gPosition[0] + set.root;
    gNear.slack = margin + gFrame.sphereDisplacement * set.step;
    [loop] for (uint k = 0; k < set.count; ++k) {
        // In the world, whose rounding the factor covers.
        const float3 offset = gNear.from_ws - sphereCentre(set.first + k, set.step);
        const float far = reachOf(set, k, collisionRadius) * 1.0001 + margin;
        if (dot(offset, offset) <= far * far) gNear.spheres |= bitOfSphere(k);
    }
}

/// Those in which each of the thread's points lies, whose list holds.
void spheresTouched(SphereSet set, out SphereBits touched[POINTS_PER_THREAD]) {
    SphereBits left = gNear.spheres;
    EACH_OWN_POINT(i) touched[i] = NO_SPHERES;
    [loop] while (hasSphere(left)) {
        const uint k = takeSphere(left);
        const float3 centre = centreOf(set, k);
        EACH_OWN_POINT(n) {
            const float3 offset = gPosition[n] - centre;
            const float reach = reachOf(set, k, collisionRadiusAt(pointOf(n)));
            if (isFree(n) && dot(offset, offset) < reach * reach) touched[n] |= bitOfSphere(k);
        }
    }
}

Contact contactOf(SphereSet set, uint k, float collisionRadius, float3 from) {
    Contact contact;
    contact.centre = centreOf(set, k);
    contact.step = gSpheres[set.first + k].step.xyz;
    contact.reach = reachOf(set, k, collisionRadius);
    contact.from = from;
    return contact;
}

/// The way out of sphere `next` for a point that left sphere `last` into it, from the centre of `next`.
float3 exitDirection(SphereSet set, uint last, uint next, float collisionRadius, float3 at) {
    const Contact left = contactOf(set, last, collisionRadius, float3(0, 0, 0));
    const float3 centre = centreOf(set, next);
    bool meet;
    const float3 onCircle = nearestOfCircle(at, left, centre, reachOf(set, next, collisionRadius), meet);
    return meet ? onCircle : at - centre;
}

/// Points that left a sphere, `last`, into others of a union go to the circle that their last sphere and the one in
/// which they are deepest have in common, until they are free. `settles`: those that left one.
void settleOwn(SphereSet set, uint last[POINTS_PER_THREAD], bool settles[POINTS_PER_THREAD], inout float3 ats[POINTS_PER_THREAD], inout float3 befores[POINTS_PER_THREAD]) {
    [loop] for (uint n = 0; n < 16; ++n) {
        SphereBits near[POINTS_PER_THREAD], left = NO_SPHERES;
        float deepest[POINTS_PER_THREAD];
        uint next[POINTS_PER_THREAD];
        bool inside[POINTS_PER_THREAD];
        EACH_OWN_POINT(i) {
            deepest[i] = 0.0;
            next[i] = last[i];
            inside[i] = n > 0u;
            near[i] = NO_SPHERES;
            if (settles[i]) near[i] = listHolds(set, ats[i]) ? gNear.spheres : firstSpheres(set.count);
            // It was just placed on that one.
            if (n == 0u) near[i] &= ~bitOfSphere(last[i]);
            left |= near[i];
        }
        [loop] while (hasSphere(left)) {
            const uint k = takeSphere(left);
            const float3 centre = centreOf(set, k);
            EACH_OWN_POINT(t) {
                const float3 offset = ats[t] - centre;
                const float reach = reachOf(set, k, collisionRadiusAt(pointOf(t))), squared = dot(offset, offset);
                const bool counts = hasSphere(near[t] & bitOfSphere(k));
                inside[t] = inside[t] || (counts && squared < reach * reach);
                // About twice the reach times the depth, but for the depth that rounding leaves.
                const float depth = reach * (reach - 4e-6) - squared;
                if (counts && depth > deepest[t]) {
                    deepest[t] = depth;
                    next[t] = k;
                }
            }
        }
        bool any = false;
        EACH_OWN_POINT(m) {
            settles[m] = settles[m] && inside[m] && deepest[m] > 0.0;
            any = any || settles[m];
        }
        if (!any) return;
        EACH_OWN_POINT(o) {
            const float collisionRadius = collisionRadiusAt(pointOf(o));
            float3 at = ats[o], before = befores[o];
            respond(contactOf(set, next[o], collisionRadius, exitDirection(set, last[o], next[o], collisionRadius, at)), at, before);
            ats[o] = settles[o] ? at : ats[o];
            befores[o] = settles[o] ? before : befores[o];
            last[o] = next[o];
        }
    }
}

/// Pushes the thread's points of `ready` out of their spheres, but those that are deep in one, of which it returns bits: they
/// ask where the point before them has gone. With `inners` they know. Only spheres in which they are at the start count: one that
/// another pushes them into is settled. What a point does not need is worked out all the same, so that the points go side by side.
uint leaveOwn(SphereSet set, bool backward, uint ready, bool knowsInner, float3 inners[POINTS_PER_THREAD]) {
    SphereBits touched[POINTS_PER_THREAD], all = NO_SPHERES;
    spheresTouched(set, touched);
    EACH_OWN_POINT(c) {
        if ((ready & 1u << c) == 0u) touched[c] = NO_SPHERES;
        all |= touched[c];
    }
    if (!hasSphere(all)) return 0u;
    float3 ats[POINTS_PER_THREAD] = gPosition;
    float3 befores[POINTS_PER_THREAD] = gPrevious;
    uint asking = 0u;
    [loop] while (hasSphere(all)) {
        uint last[POINTS_PER_THREAD];
        bool settles[POINTS_PER_THREAD];
        EACH_OWN_POINT(i) {
            const bool touches = hasSphere(touched[i]);
            last[i] = 0u;
            if (touches) last[i] = takeSphere(touched[i]);
            const float3 offset = ats[i] - centreOf(set, last[i]);
            Contact contact = contactOf(set, last[i], collisionRadiusAt(pointOf(i)), offset);
            const float squared = dot(offset, offset), reachSquared = contact.reach * contact.reach;
            settles[i] = touches && squared < reachSquared;
            float3 at = ats[i], before = befores[i];
            if (backward) contact.from = backAlong(offset, at - before - contact.step, squared, contact.reach);
            if (settles[i] && gFrame.lengthIterations > 0u && squared < reachSquared * (HAIRLOOM_DEEP_IN_SPHERE * HAIRLOOM_DEEP_IN_SPHERE)) {
                if (knowsInner) {
                    contact.from = acrossStrand(offset, at - inners[i]);
                } else {
                    asking |= 1u << i;
                    settles[i] = false;
                    touched[i] = NO_SPHERES;
                }
            }
            respond(contact, at, before);
            ats[i] = settles[i] ? at : ats[i];
            befores[i] = settles[i] ? before : befores[i];
        }
        settleOwn(set, last, settles, ats, befores);
        all = NO_SPHERES;
        EACH_OWN_POINT(b) all |= touched[b];
    }
    EACH_OWN_POINT(o) {
        if ((ready & ~asking & 1u << o) != 0u) {
            gPosition[o] = ats[o];
            gPrevious[o] = befores[o];
        }
    }
    return asking;
}

/// Pushes points, with their collision radius, out of the spheres of a set (Eq. 14).
void collideWith(SphereSet set, bool backward) {
    keepList(set);
    float3 inners[POINTS_PER_THREAD] = gPosition;
    uint asking = leaveOwn(set, backward, (1u << POINTS_PER_THREAD) - 1u, false, inners);
    // Round by round those go whose inner point has gone.
    [loop] while (anyLane(asking != 0u)) {
        Float4s positions = toFloat4s(gPosition);
        EACH_OWN_POINT(i) positions[i].w = (asking & 1u << i) != 0u ? 1.0 : 0.0;
        exchangeLast(positions[POINTS_PER_THREAD - 1]);
        const float4 before = loadInner();
        uint ready = 0u;
        EACH_OWN_POINT(k) {
            const float4 inner = INNER_OF(positions, k, before);
            inners[k] = inner.xyz;
            if ((asking & 1u << k) != 0u && inner.w == 0.0) ready |= 1u << k;
        }
        leaveOwn(set, backward, ready, true, inners);
        asking &= ~ready;
    }
}

void collide(bool backward) {
    SphereSet set;
    set.step = float(gSubstep + 1);
    set.root = gRoot + gRootDisplacement * set.step;
    set.first = 0;
#if HAIR_SPHERES == 1
    set.count = gFrame.sphereCount;
    collideWith(set, backward);
#else
    [loop] for (; set.first < gFrame.sphereCount; set.first += SPHERE_SET) {
        set.count = min(gFrame.sphereCount - set.first, uint(SPHERE_SET));
        collideWith(set, backward);
    }
    if (gFrame.sphereCount > SPHERE_SET) EACH_OWN_POINT(i) {
        float3 at = gPosition[i], before = gPrevious[i];
        if (pointOf(i) >= FIRST_FREE && settleSets(pointOf(i), set.root, set.step, at, before)) {
            gPosition[i] = at;
            gPrevious[i] = before;
        }
    }
#endif
}
