// SPDX-License-Identifier: MIT
// Contacts of rods with spheres: potentials of a node that enter its solve (docs/engine.md, "Contacts").
#include "spheres.hlsli"

/// The contacts of a node: ½ c + g·x + ½ xᵀH x in its displacement x beyond the predicted one.
struct RodContact {
    float3 diagonal;  // of the Hessian: xx, yy, zz
    float3 others;    // xy, xz, yz
    float3 gradient;
    float twiceEnergy;
    float touching;   // 1 where there is any, 2 where friction gives way at one
    float3 normal;    // sum of their normals
};

#define CONTACT_PLANE HAIRLOOM_ROD_WORK_PLANES
BUFFER_ARRAY(float3, contactDiagonal, setContactDiagonal, gScratch, CONTACT_PLANE)
BUFFER_ARRAY(float3, contactOthers, setContactOthers, gScratch, CONTACT_PLANE + 3)
BUFFER_ARRAY(float3, contactGradient, setContactGradient, gScratch, CONTACT_PLANE + 6)
BUFFER_ARRAY(float3, contactNormal, setContactNormal, gScratch, CONTACT_PLANE + 11)
RodContact contact(uint j) {
    RodContact result;
    result.diagonal = contactDiagonal(j);
    result.others = contactOthers(j);
    result.gradient = contactGradient(j);
    result.twiceEnergy = gScratch[slotOf(CONTACT_PLANE + 9, j)];
    result.touching = gScratch[slotOf(CONTACT_PLANE + 10, j)];
    result.normal = contactNormal(j);
    return result;
}
void setContact(uint j, RodContact c) {
    setContactDiagonal(j, c.diagonal);
    setContactOthers(j, c.others);
    setContactGradient(j, c.gradient);
    gScratch[slotOf(CONTACT_PLANE + 9, j)] = c.twiceEnergy;
    gScratch[slotOf(CONTACT_PLANE + 10, j)] = c.touching;
    setContactNormal(j, c.normal);
}

float3 hessianTimes(RodContact c, float3 x) {
    return float3(mad(c.diagonal.x, x.x, mad(c.others.x, x.y, c.others.y * x.z)),
                  mad(c.others.x, x.x, mad(c.diagonal.y, x.y, c.others.z * x.z)),
                  mad(c.others.y, x.x, mad(c.others.z, x.y, c.diagonal.z * x.z)));
}
float twiceEnergyAt(RodContact c, float3 x) {
    return c.twiceEnergy + dot(c.gradient + c.gradient + hessianTimes(c, x), x);
}
/// Force of the contacts on the node.
float3 forceOf(RodContact c, float3 x) { return -c.gradient - hessianTimes(c, x); }

/// ½ k (depth − n·x)², which keeps the node out, and ½ g |T (slip + x)|², which holds it back along the surface.
void addContact(inout RodContact c, float k, float g, float3 n, float depth, float3 slip) {
    const float3 nn = n * (k - g);
    c.diagonal += mad(nn, n, float3(g, g, g));
    c.others = mad(nn.xxy, n.yzz, c.others);
    const float push = k * depth;
    c.gradient += negMad3(n, push, slip * g);
    c.twiceEnergy += mad(push, depth, g * dot(slip, slip));
}

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

/// What a node is and does in this substep.
struct RodNode {
    float3 position;      // predicted, relative to the root at the end of the substep
    float3 displacement;  // predicted, world
    float3 tangent;       // predicted, of the segment before it, world
    float3 velocity;      // of the last substep, world
    float weight;         // m/(h² D)
    float load;           // force of its contacts in the last substep; negative where it slid
    float radius;         // metres that it keeps from spheres
};

void meetSphere(uint k, float3 origin, RodNode node, float timeStep, inout RodContact c) {
    const float3 step = gSpheres[k].step.xyz;
    const float3 centre = sphereCentre(k, float(gSubstep + 1)) - origin;
    const float reach = gSpheres[k].from.w + node.radius;
    const float3 to = node.position - centre;
    const float3 moved = node.displacement - step;
    const float squared = dot(to, to);
    const float a = dot(moved, moved), farthest = reach + sqrt(a);
    const float near = farthest + HAIRLOOM_ROD_CONTACT_REACH;
    if (squared > 1.0001 * near * near) return;
    const float distance = sqrt(max(squared, 1e-18));
    float3 n = to * (1.0 / distance);
    float depth = reach - distance;
    if (distance < reach * HAIRLOOM_DEEP_IN_SPHERE) {
        const float3 across = acrossStrand(to, node.tangent);
        n = across * (1.0 / sqrt(max(dot(across, across), 1e-18)));
        const float along = dot(to, node.tangent);
        depth = sqrt(max(negMad(along, along, reach * reach), 0.0)) - dot(n, to);
    }
    const float3 from = to - moved;
    const float outside = mad(reach, -reach, dot(from, from));
    // What a contact holds is inside by a little, and stays held while the prediction lifts it off.
    bool held = depth > (node.load != 0.0 ? -HAIRLOOM_ROD_CONTACT_REACH : 0.0) || outside < 0.0;
    if (gRod.sweeps != 0u) {
        // What would pass the sphere meets it where it comes in.
        const float b = dot(from, moved);
        const float discriminant = negMad(a, outside, b * b);
        const float first = (-b - sqrt(max(discriminant, 0.0))) / max(a, 1e-30);
        if (outside >= 0.0 && discriminant > 0.0 && first >= 0.0 && first < 1.0) {
            n = mad3(moved, first, from) * (1.0 / reach);
            depth = reach - dot(n, to);
            held = true;
        }
    }
    if (!held) return;
    const float approach = dot(n, step * (1.0 / gFrame.h) - node.velocity);
    depth = mad(max(approach, 0.0) * timeStep, gFrame.substep.restitution, depth);
    const float stiffness = node.weight * HAIRLOOM_ROD_CONTACT;
    // Coulomb, with the force of the last substep and at most what stops the node. What was stuck has hardly
    // moved: where it gives way it slides by what the force beyond friction does to its own mass.
    const float3 slip = negMad3(n, dot(n, moved), moved);
    const float most = abs(node.load) * gFrame.substep.friction;
    float slid = sqrt(dot(slip, slip));
    if (node.load >= 0.0) slid = max(slid, (stiffness * slid - most) / node.weight);
    const float grip = min(most / max(slid, 1e-12), stiffness);
    addContact(c, stiffness, grip, n, depth, slip);
    c.normal += n;
    c.touching = max(c.touching, grip < stiffness ? 2.0 : 1.0);
}

/// Of all spheres that the strand can touch.
RodContact contactOf(float3 origin, RodNode node, float timeStep) {
    RodContact c;
    c.diagonal = c.others = c.gradient = c.normal = float3(0, 0, 0);
    c.twiceEnergy = c.touching = 0.0;
    // All strands of a group look at the same sphere at a time: one read of a constant serves them.
    [loop] for (uint k = 0; k < gFrame.sphereCount; ++k) {
        if ((gReachable & (1u << (k & 31u))) != 0u) meetSphere(k, origin, node, timeStep, c);
    }
    return c;
}
