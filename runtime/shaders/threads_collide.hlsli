// SPDX-License-Identifier: MIT
// Points against spheres, of a strand whose points follow each other in a thread.

/// Spheres of a set that, with the largest collision radius, meet the box of a strand, as bits.
uint2 nearSpheres(uint first, uint end, float3 low, float3 high, float3 root, float step) {
    uint2 near = uint2(0, 0);
    const float collisionRadius = max(gFrame.substep.collisionRadiusAtRoot, gFrame.substep.collisionRadiusAtTip);
    EACH_SPHERE(first, end) {
        const uint k = SPHERE_BEFORE(end);
        const float3 centre = sphereCentre(k, step) - root;
        const float3 gap = max(max(low - centre, centre - high), 0.0);
        const float reach = gSpheres[k].from.w + collisionRadius;
        const uint bit = dot(gap, gap) <= reach * reach * 1.0001 ? 1u : 0u;
        if (k - first < 32u) {
            near.x |= bit << (k - first);
        } else {
            near.y |= bit << (k - first - 32u);
        }
    }
    return near;
}

/// Pushes points, with their collision radius, out of spheres (Eq. 14).
void collide(bool backward) {
    const float step = float(gSubstep + 1);
    const float3 root = gRoot + gRootDisplacement * step;
    [loop] for (uint first = 0; first < gFrame.sphereCount; first += SPHERE_SET) {
        const uint end = min(first + SPHERE_SET, gFrame.sphereCount);
        float3 low = position(FIRST_FREE), high = low;
        EACH for (uint p = FIRST_FREE + 1; p < POINTS; ++p) {
            low = min(low, position(p));
            high = max(high, position(p));
        }
        const uint2 near = nearSpheres(first, end, low, high, root, step);
        if ((near.x | near.y) != 0u) {
            EACH for (uint q = FIRST_FREE; q < POINTS; ++q) {
                const Touch touch = touchSpheres(backward, q, position(q), previous(q), position(q - 1), true, first, end,
                                                 near, root, step);
                if (touch.touched) {
                    setPosition(q, touch.at);
                    setPrevious(q, touch.before);
                }
            }
        }
    }
#if HAIR_SPHERES != 1
    if (gFrame.sphereCount > SPHERE_SET) EACH for (uint r = FIRST_FREE; r < POINTS; ++r) {
        float3 at = position(r), before = previous(r);
        if (settleSets(r, root, step, at, before)) {
            setPosition(r, at);
            setPrevious(r, before);
        }
    }
#endif
}
