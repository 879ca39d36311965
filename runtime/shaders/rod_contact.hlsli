// SPDX-License-Identifier: MIT
// Which shapes a node of a rod meets (docs/engine.md, "Contacts").
#include "spheres.hlsli"
#if HAIR_BODY
#include "rod_body.hlsli"
#endif

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

// Shapes are spheres, and behind them capsules, each of two spheres of the buffer.
uint shapeCount() { return gFrame.sphereCount + gRod.capsules; }
/// Of capsule c, its first or second end.
uint endOf(uint c, uint end) { return gFrame.sphereCount + 2u * c + end; }

// Shapes that the strand can touch in this frame, by their number modulo 32.
static uint gReachable;

void findReachableShapes() {
    const float count = float(gFrame.substeps);
    float hair = max(gFrame.substep.collisionRadiusAtRoot, gFrame.substep.collisionRadiusAtTip);
    [loop] for (uint j = 0; j + 1 < POINTS; ++j) hair += segmentLength(j);
    const float3 middle = gRoot + gRootDisplacement * (0.5 * count);
    const float rootStep = sqrt(dot(gRootDisplacement, gRootDisplacement));
    gReachable = 0u;
    [loop] for (uint k = 0; k < shapeCount(); ++k) {
        uint first = k, second = k;
        if (k >= gFrame.sphereCount) {
            first = endOf(k - gFrame.sphereCount, 0u);
            second = first + 1u;
        }
        // Ends go evenly, so that they are farthest apart at the start or the end of the frame.
        const float3 before = gSpheres[second].from.xyz - gSpheres[first].from.xyz;
        const float3 after = sphereCentre(second, count) - sphereCentre(first, count);
        const float apart = sqrt(max(dot(before, before), dot(after, after)));
        const float widest = max(gSpheres[first].from.w, gSpheres[second].from.w);
        const float3 step = gSpheres[first].step.xyz, other = gSpheres[second].step.xyz;
        const float fastest = sqrt(max(dot(step, step), dot(other, other)));
        const float3 gap = middle - 0.5 * (sphereCentre(first, 0.5 * count) + sphereCentre(second, 0.5 * count));
        const float reach = hair + 0.5 * apart + widest + 0.5 * count * (fastest + rootStep);
        // A thousandth for what rounding takes.
        if (dot(gap, gap) <= 1.001 * reach * reach) gReachable |= 1u << (k & 31u);
    }
}

/// The sphere of shape k that a node meets, which is all of a sphere; centres are from `origin`. Microsoft's compiler takes
/// what an earlier return leaves unset for unset everywhere.
RodCapsuleSphere sphereMet(uint k, float3 origin, RodNode node) {
    const float steps = float(gSubstep + 1);
    RodCapsuleSphere sphere;
    if (k < gFrame.sphereCount) {
        sphere.centre = sphereCentre(k, steps) - origin;
        sphere.step = gSpheres[k].step.xyz;
        sphere.radius = gSpheres[k].from.w;
    } else {
        const uint first = endOf(k - gFrame.sphereCount, 0u), second = first + 1u;
        RodCapsule capsule;
        capsule.from = sphereCentre(first, steps) - origin;
        capsule.axis = sphereCentre(second, steps) - sphereCentre(first, steps);
        capsule.step = gSpheres[first].step.xyz;
        capsule.turn = gSpheres[second].step.xyz - capsule.step;
        capsule.radius = gSpheres[first].from.w;
        capsule.narrows = capsule.radius - gSpheres[second].from.w;
        capsule.thinnest = min(capsule.radius, gSpheres[second].from.w);
        sphere = rodCapsuleNearest(capsule, node.position);
        if (gRod.sweeps != 0u)
            sphere = rodCapsuleMet(capsule, node.position, node.displacement, node.radius, sphere);
    }
    return sphere;
}

/// Whether shape k is near a node, and how they touch; `origin` is where the root is at the end of the substep. By far
/// more than rounding most nodes are neither inside a shape nor come out of one or past it.
bool touchShape(uint k, float3 origin, RodNode node, out RodTouch touch) {
    const RodCapsuleSphere sphere = sphereMet(k, origin, node);
    touch = rodTouchSphere(node, sphere.centre, sphere.step, sphere.radius, gRod.sweeps != 0u);
    const float3 to = node.position - sphere.centre;
    const float farthest = sqrt(dot(node.displacement, node.displacement)) + node.radius +
                           1.001 * (sphere.radius + sqrt(dot(sphere.step, sphere.step))) + HAIRLOOM_ROD_CONTACT_NEAR;
    return dot(to, to) <= farthest * farthest;
}

/// Whether the strand may touch anything in this frame.
bool meetsShapes() {
#if HAIR_BODY
    return true;
#else
    return gReachable != 0u;
#endif
}

/// All strands of a group look at the same shape at a time: one read of a constant serves them.
#define EACH_SHAPE(k) \
    [loop] for (uint k = 0; k < shapeCount(); ++k) \
        if ((gReachable & (1u << (k & 31u))) != 0u)

/// Metres outside a shape at which it holds a node that the prediction has there.
float slackAsPredicted(RodTouch touch, RodNode node) {
#if HAIR_BODY
    return bodySlackAfter(touch, node);
#else
    return rodSlackAfter(node.load);
#endif
}

/// What the shapes do to node p that hold it; whether any is near it. It may be outside by `slack` metres, or, as predicted, by as
/// much as its last contact says. Of those that press alike, as two capsules do at the end that they share, one that another keeps
/// the node off does not hold it back, and friction is by the force of all of them together (RodStrip::pressedBySeveral()). Folds of
/// skin hold by several planes in turn: what presses there twice calms it.
RodContact contactOf(float3 origin, uint p, RodNode node, bool isPredicted, float slack, out bool near) {
    RodContact found = noContact();
    float friction = gFrame.substep.friction, least = -1e9;
    near = false;
    [loop] for (uint turn = 0; turn < 3u; ++turn) {
        float deepest = -1e9;
        found = noContact();
        EACH_SHAPE(k) {
            RodTouch touch;
            if (touchShape(k, origin, node, touch)) {
                near = true;
                const float reach = isPredicted ? slackAsPredicted(touch, node) : slack;
                if (rodHolds(touch, reach) && touch.depth >= least) {
                    deepest = max(deepest, touch.depth);
                    rodPress(touch, true, node, 1.0 / gFrame.h, friction, gFrame.substep.restitution, found);
                }
            }
        }
#if HAIR_BODY
        [loop] for (uint which = 0; which < 2u; ++which) {
            RodTouch skin;
            if (touchOfBody(which, p, node, skin)) {
                near = true;
                const float reach = isPredicted ? bodySlackAfter(skin, node) : slack;
                if (rodHolds(skin, reach))
                    rodPress(skin, true, node, 1.0 / gFrame.h, friction, gFrame.substep.restitution, found);
            }
        }
        break;
#endif
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
