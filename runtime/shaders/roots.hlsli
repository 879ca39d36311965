// SPDX-License-Identifier: MIT
// The way of the roots through a frame.

/// From one rotation to another by the share t of the way.
float4 rotationBetween(float4 from, float4 to, float t) {
    const float4 mixed = from + ((dot(from, to) < 0.0 ? -to : to) - from) * t;
    return mixed * (1.0 / sqrt(dot(mixed, mixed)));
}

#if HAIR_STORAGE == 3
// What the root carries in each of as many substeps as the strand has threads, of which each makes one.
groupshared float3 gTangents[HAIR_THREADS];
#if HAIR_TARGETS
groupshared float3 gNormals[HAIR_THREADS];
#endif
static float gRootLength;
static bool gTeleported;  // the root has jumped, and does not turn in this frame

/// Of this substep and the next ones, as many as the strand has threads.
void carryRoot() {
    const float4 to = gRootsTo[2 * gSlot + 1];
    float4 from = to;
    if (!gTeleported) from = float4(rootRow(3), rootRow(4), rootRow(5), rootRow(6));
    const float4 now = rotationBetween(from, to, float(gSubstep + gThread + 1) / float(gFrame.substeps));
    GroupMemoryBarrierWithGroupSync();
    gTangents[gThreadInGroup] = rotate(now, restVector(0) * inverseLength(0));
#if HAIR_TARGETS
    gNormals[gThreadInGroup] = rotate(now, target(POINTS - 1));
#endif
    GroupMemoryBarrierWithGroupSync();
}
uint threadOfSubstep() { return gThreadInGroup - gThread + gSubstep % STRAND_THREADS; }
void turnRoot() {
    if (gSubstep % STRAND_THREADS == 0) carryRoot();
}
/// The direction and the normal that the root carries, before the first segment.
float3 rootTangent() { return gTangents[threadOfSubstep()]; }
float3 firstSegment() { return rootTangent() * gRootLength; }
#if HAIR_TARGETS
float3 rootNormal() { return gNormals[threadOfSubstep()]; }
#endif
#else
static float4 gRotationFrom, gRotationTo;
static float4 gRotation;     // of now
static float4 gRootSegment;  // the first at rest; w: 1/length
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
    gRotation = rotationBetween(gRotationFrom, gRotationTo, float(gSubstep + 1) / float(gFrame.substeps));
}

float3 firstSegment() { return rotate(gRotation, gRootSegment.xyz); }
/// The direction and the normal that the root carries, before the first segment.
float3 rootTangent() { return rotate(gRotation, gRootSegment.xyz * gRootSegment.w); }
#if HAIR_TARGETS
float3 rootNormal() { return rotate(gRotation, gNormalAtRest); }
#endif
#endif

/// Takes the way of the root through the frame.
void enterFrame() {
#if HAIR_RODS
    ALONE {
        if (gRod.fresh == HAIRLOOM_RODS_FRESH) placeRodOnPoints();
        if (gRod.fresh == HAIRLOOM_RODS_OF_OTHER_ENERGY) setEnergyBefore(HAIRLOOM_ROD_NO_ENERGY);
    }
#endif
    float3 from = float3(rootRow(0), rootRow(1), rootRow(2));
    float4 rotationFrom = float4(rootRow(3), rootRow(4), rootRow(5), rootRow(6));
    const float3 to = gRootsTo[2 * gSlot].xyz;
    const float4 turnedTo = gRootsTo[2 * gSlot + 1];
    const float3 displacement = to - from;
    // A cut carries the strand along rigidly.
    const bool teleported = !(dot(displacement, displacement) <= gFrame.teleportDistance * abs(gFrame.teleportDistance));
    if (teleported) {
        const float4 turn = multiply(turnedTo, conjugate(rotationFrom));
        ALONE ALL_POINTS(p) {
            setPosition(p, rotate(turn, position(p)));
            setPrevious(p, rotate(turn, previous(p)));
#if HAIR_RODS
            turnRodAlong(p, turn);
#endif
        }
        from = to;
        rotationFrom = turnedTo;
    }
    gRoot = from;
    gRootDisplacement = (to - from) / float(gFrame.substeps);
#if HAIR_STORAGE == 3
    gTeleported = teleported;
    gRootLength = segmentLength(0);
#else
    setRotations(rotationFrom, turnedTo);
#endif
}

void leaveFrame() {
    const float3 to = gRootsTo[2 * gSlot].xyz;
    const float4 turned = gRootsTo[2 * gSlot + 1];
    const float values[7] = {to.x, to.y, to.z, turned.x, turned.y, turned.z, turned.w};
    [unroll] for (uint row = 0; row < 7; ++row) gRoots[row * gFrame.slots + gSlot] = values[row];
}

/// Turns the root to where it is at the end of the substep and takes the clamped points along.
void stageRoots() {
    turnRoot();
    ONLY_POINT(0) setPrevious(0, -gRootDisplacement);
#if HAIR_CLAMPED > 1
    ONLY_POINT(1) {
        setPrevious(ownOf(1), position(ownOf(1)) - gRootDisplacement);
        setPosition(ownOf(1), firstSegment());
    }
#endif
}

/// The speed stays when the length of the substep changes.
void rescaleMotion() {
    ALL_POINTS(p)
        setPrevious(p, position(p) - (position(p) - previous(p)) * gFrame.rescale);
}
