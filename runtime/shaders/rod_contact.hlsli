// SPDX-License-Identifier: MIT
// Which shapes a node of a rod meets (docs/engine.md, "Contacts").
#include "spheres.hlsli"

#define CONTACT_PLANE HAIRLOOM_ROD_WORK_PLANES
BUFFER_ARRAY(float3, contactGradient, setContactGradient, gScratch, CONTACT_PLANE + 6)
BUFFER_ARRAY(float3, contactNormal, setContactNormal, gScratch, CONTACT_PLANE + 11)
RodContact contact(uint j) {
    RodContact result;
    [unroll] for (uint i = 0; i < 6; ++i) result.hessian[i] = gScratch[slotOf(CONTACT_PLANE + i, j)];
    result.gradient = contactGradient(j);
    result.twiceEnergy = gScratch[slotOf(CONTACT_PLANE + 9, j)];
    result.touching = gScratch[slotOf(CONTACT_PLANE + 10, j)];
    result.normal = contactNormal(j);
    return result;
}
void setContact(uint j, RodContact c) {
    [unroll] for (uint i = 0; i < 6; ++i) gScratch[slotOf(CONTACT_PLANE + i, j)] = c.hessian[i];
    setContactGradient(j, c.gradient);
    gScratch[slotOf(CONTACT_PLANE + 9, j)] = c.twiceEnergy;
    gScratch[slotOf(CONTACT_PLANE + 10, j)] = c.touching;
    setContactNormal(j, c.normal);
}
RodContact noContact() {
    RodContact c;
    [unroll] for (uint i = 0; i < 6; ++i) c.hessian[i] = 0.0;
    c.gradient = c.normal = float3(0, 0, 0);
    c.twiceEnergy = c.touching = 0.0;
    return c;
}
/// Whether a shape is near the outer node of segment j, as predicted.
bool isNear(uint j) { return gScratch[slotOf(CONTACT_PLANE + 14, j)] != 0.0; }
void setNear(uint j, bool near) { gScratch[slotOf(CONTACT_PLANE + 14, j)] = near ? 1.0 : 0.0; }

// Spheres that the strand can touch in this frame, by their number modulo 32.
static uint gReachable;

void findReachableSpheres() {
    const float count = float(gFrame.substeps);
    float hair = max(gFrame.substep.collisionRadiusAtRoot, gFrame.substep.collisionRadiusAtTip);
    [loop] for (uint j = 0; j + 1 < POINTS; ++j) hair += segmentLength(j);
    const float3 middle = gRoot + gRootDisplacement * (0.5 * count);
    const float rootStep = sqrt(dot(gRootDisplacement, gRootDisplacement));
    gReachable = 0u;
    [loop] for (uint k = 0; k < gFrame.sphereCount; ++k) {
        const float3 step = gSpheres[k].step.xyz;
        const float3 gap = middle - sphereCentre(k, 0.5 * count);
        const float reach = hair + gSpheres[k].from.w + 0.5 * count * (sqrt(dot(step, step)) + rootStep);
        // A thousandth for what rounding takes.
        if (dot(gap, gap) <= 1.001 * reach * reach) gReachable |= 1u << (k & 31u);
    }
}

/// Whether sphere k is near a node, and how they touch; `origin` is where the root is at the end of the substep. By far
/// more than rounding most nodes are neither inside a sphere nor come out of one or past it.
bool touchSphere(uint k, float3 origin, RodNode node, out RodTouch touch) {
    const float3 step = gSpheres[k].step.xyz;
    const float3 centre = sphereCentre(k, float(gSubstep + 1)) - origin;
    touch = rodTouchSphere(node, centre, step, gSpheres[k].from.w, gRod.sweeps != 0u);
    const float3 to = node.position - centre;
    const float farthest = sqrt(dot(node.displacement, node.displacement)) + node.radius +
                           1.001 * (gSpheres[k].from.w + sqrt(dot(step, step))) + HAIRLOOM_ROD_CONTACT_NEAR;
    return dot(to, to) <= farthest * farthest;
}

/// All strands of a group look at the same sphere at a time: one read of a constant serves them.
#define EACH_SPHERE(k) \
    [loop] for (uint k = 0; k < gFrame.sphereCount; ++k) \
        if ((gReachable & (1u << (k & 31u))) != 0u)

/// What the spheres do to a node that hold it, which may be outside by `slack` metres; whether any is near it. Of those
/// that press alike, as spheres along a capsule do, one that another keeps the node off does not hold it back, and
/// friction is by the force of all of them together (RodStrip::pressedBySeveral()).
RodContact contactOf(float3 origin, RodNode node, float slack, out bool near) {
    RodContact found = noContact();
    float friction = gFrame.substep.friction, least = -1e9;
    near = false;
    [loop] for (uint turn = 0; turn < 3u; ++turn) {
        float deepest = -1e9;
        found = noContact();
        EACH_SPHERE(k) {
            RodTouch touch;
            if (touchSphere(k, origin, node, touch)) {
                near = true;
                if (rodHolds(touch, slack) && touch.depth >= least) {
                    deepest = max(deepest, touch.depth);
                    rodPress(touch, true, node, 1.0 / gFrame.h, friction, gFrame.substep.restitution, found);
                }
            }
        }
        const float alike = rodPressAlike(found);
        if (alike <= 1.0) break;
        if (turn == 0u) {
            least = min(deepest, 0.0);
        } else {
            friction = gFrame.substep.friction / alike;
        }
    }
    return found;
}
