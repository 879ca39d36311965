// SPDX-License-Identifier: MIT
// The way of the roots through a frame.

float rootRow(uint row) { return gRoots[row * gFrame.slots + gSlot]; }

/// From one rotation to another by the share t of the way.
float4 rotationBetween(float4 from, float4 to, float t) {
    const float4 mixed = from + ((dot(from, to) < 0.0 ? -to : to) - from) * t;
    return mixed * (1.0 / sqrt(dot(mixed, mixed)));
}

static float4 gRotationFrom, gRotationTo;
static float4 gRotation;     // of now
static float4 gTurn;         // from the rotation a substep ago to that of now
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
    const float4 now = rotationBetween(gRotationFrom, gRotationTo, float(gSubstep + 1) / float(gFrame.substeps));
    gTurn = multiply(now, conjugate(gRotation));
    gRotation = now;
}

float4 turnNow() { return gTurn; }
float3 firstSegment() { return rotate(gRotation, gRootSegment.xyz); }
/// The direction and the normal that the root carries, before the first segment.
float3 rootTangent() { return rotate(gRotation, gRootSegment.xyz * gRootSegment.w); }
#if HAIR_TARGETS
float3 rootNormal() { return rotate(gRotation, gNormalAtRest); }
#endif

/// Takes the way of the root through the frame.
void enterFrame() {
    float3 from = float3(rootRow(0), rootRow(1), rootRow(2));
    float4 rotationFrom = float4(rootRow(3), rootRow(4), rootRow(5), rootRow(6));
    const float3 to = gRootsTo[2 * gSlot].xyz;
    const float4 rotationTo = gRootsTo[2 * gSlot + 1];
    const float3 way = to - from;
    // A cut carries the strand along rigidly.
    if (!(dot(way, way) <= gFrame.teleportDistance * gFrame.teleportDistance)) {
        const float4 turn = multiply(rotationTo, conjugate(rotationFrom));
        ALL_POINTS(p) {
            setPosition(p, rotate(turn, position(p)));
            setPrevious(p, rotate(turn, previous(p)));
#if HAIR_CURVES
            setCurve(p, rotate(turn, curve(p)));
#endif
        }
        from = to;
        rotationFrom = rotationTo;
    }
    gRoot = from;
    gRootStep = (to - from) / float(gFrame.substeps);
    setRotations(rotationFrom, rotationTo);
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
    ONLY_POINT(0) setPrevious(0, -gRootStep);
#if HAIR_CLAMPED > 1
    ONLY_POINT(1) {
        setPrevious(ownOf(1), position(ownOf(1)) - gRootStep);
        setPosition(ownOf(1), firstSegment());
    }
#endif
}

/// The speed stays when the length of the substep changes.
void rescaleMotion() {
    ALL_POINTS(p)
        setPrevious(p, position(p) - (position(p) - previous(p)) * gFrame.rescale);
}
