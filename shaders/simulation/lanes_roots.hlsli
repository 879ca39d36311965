// SPDX-License-Identifier: MIT
// The way of the roots through a frame, of strands whose points are lanes.

#if HAIR_TABLES
// Each lane makes a substep of it, as many at a time as the strand has lanes, and leaves it for all.
groupshared float4 gRotationEnds[2 * HAIR_STRANDS];  // of each strand, at the start and the end of the frame
groupshared float4 gRootTurns[HAIR_THREADS];         // from the rotation a substep ago
groupshared float4 gFirstSegments[HAIR_THREADS];     // w: 1/length
#if HAIR_TARGETS
groupshared float4 gRootNormals[HAIR_THREADS];
#endif

void setRotations(float4 from, float4 to) {
    ONLY_POINT(0) {
        gRotationEnds[2 * gStrand] = from;
        gRotationEnds[2 * gStrand + 1] = to;
    }
}

/// After as many substeps.
float4 rotationAfter(uint substeps) {
    const float4 from = gRotationEnds[2 * gStrand], to = gRotationEnds[2 * gStrand + 1];
    return substeps == 0 ? from : rotationBetween(from, to, float(substeps) / float(gFrame.substeps));
}

void turnRoot() {
    if (gSubstep % HAIR_POINTS != 0u) return;
    // Lanes may still look at the last ones.
    GroupMemoryBarrierWithGroupSync();
    const float4 now = rotationAfter(gSubstep + gPoint + 1);
    gRootTurns[gLane] = multiply(now, conjugate(rotationAfter(gSubstep + gPoint)));
    gFirstSegments[gLane] = float4(rotate(now, restVector(0)), inverseLength(0));
#if HAIR_TARGETS
    gRootNormals[gLane] = float4(rotate(now, target(POINTS - 1)), 0);
#endif
    GroupMemoryBarrierWithGroupSync();
}

uint substepHere() { return gFirst + gSubstep % HAIR_POINTS; }
float4 turnNow() { return gRootTurns[substepHere()]; }
float3 firstSegment() { return gFirstSegments[substepHere()].xyz; }
float3 rootTangent() {
    const float4 segment = gFirstSegments[substepHere()];
    return segment.xyz * segment.w;
}
#if HAIR_TARGETS
float3 rootNormal() { return gRootNormals[substepHere()].xyz; }
#endif
#else
static float4 gRotationFrom, gRotationTo;
static float4 gRotation, gTurn;
static float4 gRootSegment;  // w: 1/length
#if HAIR_TARGETS
static float3 gNormalAtRest;
#endif

void setRotations(float4 from, float4 to) {
    gRotationFrom = gRotation = from;
    gRotationTo = to;
    gRootSegment = float4(restVector(0), inverseLength(0));
#if HAIR_TARGETS
    gNormalAtRest = target(POINTS - 1);
#endif
}

void turnRoot() {
    const float4 now = rotationBetween(gRotationFrom, gRotationTo, float(gSubstep + 1) / float(gFrame.substeps));
    gTurn = multiply(now, conjugate(gRotation));
    gRotation = now;
}

float4 turnNow() { return gTurn; }
float3 firstSegment() { return rotate(gRotation, gRootSegment.xyz); }
float3 rootTangent() { return rotate(gRotation, gRootSegment.xyz * gRootSegment.w); }
#if HAIR_TARGETS
float3 rootNormal() { return rotate(gRotation, gNormalAtRest); }
#endif
#endif
