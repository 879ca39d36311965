// SPDX-License-Identifier: MIT
// Rods where they have not come by themselves: turned along by a cut, at rest, or through given points.

/// What `p` of a strand keeps in the world turns along with its root.
void turnRodAlong(uint p, float4 turn) {
    const float4 q = multiply(turn, rotation(p));
    setRotation(p, q * (1.0 / sqrt(dot(q, q))));
    setIncrement(p, rotate(turn, increment(p)));
    setDisplacement(p, rotate(turn, displacement(p)));
    setVelocity(p, rotate(turn, velocity(p)));
    setVelocityBefore(p, rotate(turn, velocityBefore(p)));
#if HAIR_BODY
    forgetFolds(p);
#endif
}

/// At rest on the root of the end of the frame, without a step before.
void placeRodAtRest() {
    const float4 held = gRootsTo[2 * gSlot + 1];
    float4 inner = held;
    [loop] for (uint p = 0; p < POINTS; ++p) {
        float4 q = held;
        float3 atRest = float3(0, 0, 0);
        if (p + 1 < POINTS) {
            q = multiply(held, restRotation(p));
            q *= 1.0 / sqrt(dot(q, q));
            const float4 turn = multiply(conjugate(inner), q);
            atRest = turn.xyz * (turn.w < 0.0 ? -2.0 : 2.0);
        }
        const float3 none = float3(0, 0, 0);
        setRotation(p, q);
        setIncrement(p, none);
        setDisplacement(p, none);
        setVelocity(p, none);
        setVelocityBefore(p, none);
        setStrain(p, atRest);
        setStrainBefore(p, atRest);
        setLoad(p, 0.0);
        inner = q;
    }
    setLargestTurn(HAIRLOOM_ROD_NO_STEP);
    setEnergyBefore(HAIRLOOM_ROD_NO_ENERGY);
}

/// The least rotation that takes one unit vector to another.
float4 rotationTo(float3 from, float3 to) {
    const float c = dot(from, to);
    float4 turn = float4(cross(from, to), 1.0 + c);
    if (c < -0.9999) turn = float4(cross(from, abs(from.x) < 0.8 ? float3(1, 0, 0) : float3(0, 1, 0)), 0.0);
    return turn * (1.0 / sqrt(dot(turn, turn)));
}

/// Through the points of the strand, moving as they do, without twist beyond that at rest; as placeRodOnPoints().
void placeRodOnPoints() {
    const float4 held = float4(rootRow(3), rootRow(4), rootRow(5), rootRow(6));
    const float ratio = gRod.stepRatio < HAIRLOOM_ROD_NO_STEP ? gRod.stepRatio : 0.0;
    const float rate = ratio / gFrame.h;
    float4 atRestBefore = held, before = held;
    [loop] for (uint p = 0; p < POINTS; ++p) {
        const float3 moved = position(p) - previous(p);
        float4 q = held;
        float3 bent = float3(0, 0, 0);
        if (p + 1 < POINTS) {
            float4 atRest = multiply(held, restRotation(p));
            atRest *= 1.0 / sqrt(dot(atRest, atRest));
            q = p == 0 ? atRest : multiply(before, multiply(conjugate(atRestBefore), atRest));
            const float3 edge = position(p + 1) - position(p);
            const float size = sqrt(dot(edge, edge));
            if (size > 1e-9) {
                q = multiply(rotationTo(rotate(q, restTangent(p)), edge * (1.0 / size)), q);
                q *= 1.0 / sqrt(dot(q, q));
            }
            const float4 turn = multiply(conjugate(before), q);
            bent = turn.xyz * (turn.w < 0.0 ? -2.0 : 2.0);
            atRestBefore = atRest;
            before = q;
        }
        setRotation(p, q);
        setIncrement(p, float3(0, 0, 0));
        setDisplacement(p, moved);
        setVelocity(p, moved * rate);
        setVelocityBefore(p, moved * rate);
        setStrain(p, bent);
        setStrainBefore(p, bent);
        setLoad(p, 0.0);
    }
    setLargestTurn(HAIRLOOM_ROD_NO_STEP);
    setEnergyBefore(HAIRLOOM_ROD_NO_ENERGY);
}
