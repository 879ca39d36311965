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

/// The part of a point's offset from a sphere's centre across the segment before it; any direction across,
/// where there is none. Along their strand its own length would hold points back.
float3 acrossStrand(float3 offset, float3 edge) {
    const float squared = dot(edge, edge);
    const float3 across = offset - edge * (dot(offset, edge) / max(squared, 1e-18));
    const float3 level = float3(edge.z, 0.0, -edge.x);
    const float3 other = dot(level, level) <= squared * 1e-6 ? float3(edge.y, 0.0, 0.0) : level;
    const bool centred = dot(across, across) <= squared * 1e-8;
    return squared > 1e-18 ? (centred ? other : across) : offset;
}
