// SPDX-License-Identifier: MIT
// Spheres of the frame, and the radius that keeps points off them.

#if HAIR_SPHERES == 1
cbuffer Spheres : register(b1) { SphereConstants gSpheres[HAIRLOOM_CONSTANT_SPHERES]; };
#else
StructuredBuffer<SphereConstants> gSpheres : register(t7);
#endif

float3 sphereCentre(uint k, float step) { return gSpheres[k].from.xyz + gSpheres[k].step.xyz * step; }

/// Collision radius at a point, growing linearly to the tip.
float collisionRadiusAt(uint p) {
    return gFrame.substep.collisionRadiusAtRoot + (gFrame.substep.collisionRadiusAtTip - gFrame.substep.collisionRadiusAtRoot) / float(POINTS - 1) * float(p);
}
