// SPDX-License-Identifier: MIT
// Where the numbers of a rod are; laid out as storage.hlsli has it. Those of segment or vertex j stand at j; a
// vertex stands at its outer segment, the outer node of segment j at j + 1.

StructuredBuffer<float4> gRodRest : register(t2);     // tangent, B/l̄ of the vertex; from the shape without load to that of rest; axis; of flat sections: long diameter
StructuredBuffer<float> gRodMasses : register(t3);    // of each point, metres of hair
StructuredBuffer<uint> gCurvedBlocks : register(t9);  // per work group: twist matters
#if HAIR_POSES
StructuredBuffer<float4> gRodPoses : register(t10);   // of a node: where it is drawn to, in the root's frame, and how fast, 1/s; the strain that a vertex rests at
float4 poseOf(uint p) { return gRodPoses[slotOf(0, p)]; }
float3 poseStrain(uint j) { return gRodPoses[slotOf(1, j)].xyz; }
#endif
RWStructuredBuffer<float> gRodState : register(u5);   // as RodView has it: planes, then turn and energy of a strand

float4 restTangentAndBend(uint j) { return gRodRest[slotOf(0, j)]; }
float3 restTangent(uint j) { return gRodRest[slotOf(0, j)].xyz; }
float4 restRotation(uint j) { return gRodRest[slotOf(1, j)]; }
float mass(uint p) { return gRodMasses[slotOf(0, p)]; }

static bool gCurved;  // alike in the whole work group
/// Of vertex j, for its B/l̄.
RodSection section(uint j, float bend) {
    RodSection found;
    found.axis = found.normal = float3(0, 0, 0);
    found.twists = gCurved;
    found.isFlat = gRod.numbers.flat != 0.0;
    found.twist = bend * gRod.numbers.twist;
    found.flat = bend * gRod.numbers.flat;
    if (found.twists) found.axis = gRodRest[slotOf(2, j)].xyz;
    if (found.isFlat) found.normal = gRodRest[slotOf(3, j)].xyz;
    return found;
}

#define BUFFER_QUATERNIONS(get, put, buffer, plane) \
    float4 get(uint p) { \
        return float4(buffer[slotOf(plane, p)], buffer[slotOf(plane + 1, p)], buffer[slotOf(plane + 2, p)], buffer[slotOf(plane + 3, p)]); \
    } \
    void put(uint p, float4 q) { \
        buffer[slotOf(plane, p)] = q.x; \
        buffer[slotOf(plane + 1, p)] = q.y; \
        buffer[slotOf(plane + 2, p)] = q.z; \
        buffer[slotOf(plane + 3, p)] = q.w; \
    }
BUFFER_QUATERNIONS(rotation, setRotation, gRodState, 0)
BUFFER_ARRAY(float3, increment, setIncrement, gRodState, 4)
BUFFER_ARRAY(float3, displacement, setDisplacement, gRodState, 7)
BUFFER_ARRAY(float3, velocity, setVelocity, gRodState, 10)
BUFFER_ARRAY(float3, velocityBefore, setVelocityBefore, gRodState, 13)
BUFFER_ARRAY(float3, strain, setStrain, gRodState, 16)
BUFFER_ARRAY(float3, strainBefore, setStrainBefore, gRodState, 19)
float load(uint p) { return gRodState[slotOf(22, p)]; }
void setLoad(uint p, float v) { gRodState[slotOf(22, p)] = v; }
uint slotOfLane(uint row) { return (HAIRLOOM_ROD_STATE_PLANES * HAIR_POINTS + row) * gFrame.slots + gSlot; }
float largestTurn() { return gRodState[slotOfLane(0)]; }
void setLargestTurn(float v) { gRodState[slotOfLane(0)] = v; }
float energyBefore() { return gRodState[slotOfLane(1)]; }
void setEnergyBefore(float v) { gRodState[slotOfLane(1)] = v; }

#if HAIR_BODY
// Planes of a body that pressed the point in the last substep, two: normal (0 for none) and metres outside. They are behind the rows of
// the strands.
uint slotOfFold(uint plane, uint p) {
    const uint behind = (HAIRLOOM_ROD_STATE_PLANES * HAIR_POINTS + 2) * gFrame.slots;
#if HAIR_TOGETHER
    return behind + (plane * gFrame.slots + gSlot) * HAIR_POINTS + p;
#else
    return behind + (plane * HAIR_POINTS + p) * gFrame.slots + gSlot;
#endif
}
float4 keptFold(uint which, uint p) {
    const uint plane = 4u * which;
    return float4(gRodState[slotOfFold(plane, p)], gRodState[slotOfFold(plane + 1, p)], gRodState[slotOfFold(plane + 2, p)],
                  gRodState[slotOfFold(plane + 3, p)]);
}
void keepFold(uint which, uint p, float4 fold) {
    const uint plane = 4u * which;
    gRodState[slotOfFold(plane, p)] = fold.x;
    gRodState[slotOfFold(plane + 1, p)] = fold.y;
    gRodState[slotOfFold(plane + 2, p)] = fold.z;
    gRodState[slotOfFold(plane + 3, p)] = fold.w;
}
void forgetFolds(uint p) {
    keepFold(0u, p, float4(0, 0, 0, 0));
    keepFold(1u, p, float4(0, 0, 0, 0));
}
#endif

// What a substep keeps of segment j and of its outer node while it is solved, as RodPoint of the engine.
BUFFER_QUATERNIONS(predictedRotation, setPredictedRotation, gScratch, 0)
BUFFER_QUATERNIONS(predictedRelative, setPredictedRelative, gScratch, 4)
BUFFER_ARRAY(float3, wantedStrain, setWantedStrain, gScratch, 8)
BUFFER_ARRAY(float3, predictedIncrement, setPredictedIncrement, gScratch, 11)
BUFFER_ARRAY(float3, predictedDisplacement, setPredictedDisplacement, gScratch, 14)
BUFFER_QUATERNIONS(target, setTarget, gScratch, 17)  // w: m/(h² D)
BUFFER_ARRAY(float3, newDisplacement, setNewDisplacement, gScratch, 21)
BUFFER_QUATERNIONS(newRelative, setNewRelative, gScratch, 24)
#define GAIN_PLANE 28
RodGains gains(uint j) {
    RodGains result;
    [unroll] for (uint i = 0; i < 21; ++i) result.k[i] = gScratch[slotOf(GAIN_PLANE + i, j)];
    return result;
}
void setGains(uint j, RodGains values) {
    [unroll] for (uint i = 0; i < 21; ++i) gScratch[slotOf(GAIN_PLANE + i, j)] = values.k[i];
}
