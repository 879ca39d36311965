// SPDX-License-Identifier: MIT
// The way of the roots through a frame.

float rootRow(uint row) { return gRoots[row * gFrame.slots + gSlot]; }

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
    gRotationFrom = gRotation = rotationFrom;
    gRotationTo = rotationTo;
}

void leaveFrame() {
    const float3 to = gRootsTo[2 * gSlot].xyz;
    const float values[7] = {to.x, to.y, to.z, gRotationTo.x, gRotationTo.y, gRotationTo.z, gRotationTo.w};
    [unroll] for (uint row = 0; row < 7; ++row) gRoots[row * gFrame.slots + gSlot] = values[row];
}

/// Turns the root to where it is at the end of the substep and takes the clamped points along.
void stageRoots() {
    const float t = float(gSubstep + 1) / float(gFrame.substeps);
    const float4 to = dot(gRotationFrom, gRotationTo) < 0.0 ? -gRotationTo : gRotationTo;
    const float4 mixed = gRotationFrom + (to - gRotationFrom) * t;
    const float4 now = mixed * (1.0 / sqrt(dot(mixed, mixed)));
    gTurn = multiply(now, conjugate(gRotation));
    gRotation = now;
    ONLY_POINT(0) setPrevious(0, -gRootStep);
#if HAIR_CLAMPED > 1
    ONLY_POINT(1) {
        setPrevious(1, position(1) - gRootStep);
        setPosition(1, rotate(now, rootSegment()));
    }
#endif
}

/// The speed stays when the length of the substep changes.
void rescaleMotion() {
    ALL_POINTS(p)
        setPrevious(p, position(p) - (position(p) - previous(p)) * gFrame.rescale);
}
