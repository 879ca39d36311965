// SPDX-License-Identifier: MIT
// Where a strand's numbers are. In buffers index = (plane · HAIR_POINTS + point) · slots + slot, or, with
// HAIR_TOGETHER, (plane · slots + slot) · HAIR_POINTS + point, so that neighbouring threads, of strands or of points, read
// neighbouring floats. Between the substeps of a frame a strand lives
//   HAIR_STORAGE 0: in arrays of its thread (registers where HAIR_UNROLL makes all indices constant),
//   HAIR_STORAGE 1: position and previous in the memory of the work group, the rest as 0,
//   HAIR_STORAGE 2: in the buffers, for strands too long for either,
//   HAIR_STORAGE 3: each point in a thread of its own, see lanes.hlsli,
//   HAIR_STORAGE 4: as 1, but the work group has one strand, and its first thread takes it: see frame_wisps.hlsli.
//
// Positions are relative to the strand's root; `previous` is the position one substep ago relative to the root
// of now, so position − previous is the displacement in the world. Forces add a·h² to it by taking it from
// `previous`.

// Of rods HAIR_MEMBERS threads may share a strand, see rod_members.hlsli; elsewhere it is 1.

#if HAIR_MEMBERS > 1
static uint gMember;  // which of the threads of its strand
/// Before what one of them does for all.
#define ALONE if (gMember == 0u)
#else
#define ALONE
#endif

cbuffer Frame : register(b0) { SimulationConstants gFrame; };

StructuredBuffer<float4> gRest : register(t0);       // rest vector of the segment after the point, its length
StructuredBuffer<float2> gSegments : register(t1);   // that length, the point's inverse mass
StructuredBuffer<uint2> gBlocks : register(t4);      // points of each strand of a work group, strands
StructuredBuffer<uint> gFirstPoints : register(t5);  // place in the caller's order
StructuredBuffer<float4> gRootsTo : register(t6);    // position, 1 where it moves; rotation at the end of the frame

RWStructuredBuffer<float> gState : register(u0);     // position x y z, previous x y z, tension
RWStructuredBuffer<float> gRoots : register(u1);     // position, rotation at the end of the last frame
RWStructuredBuffer<uint> gReport : register(u3);     // see the indices below
RWStructuredBuffer<float4> gPositions_ws : register(u4);  // in the caller's order, w 1

#define REPORT_FASTEST 0   // bits of the greatest squared displacement of a substep
#define REPORT_RESTORED 1  // strands put back to rest
#define REPORT_ASLEEP 2    // strands
#define REPORT_GUARDED 3   // rods whose speeds were taken back

// Direct3D 11.0 has u0 to u7; scratch memory takes the last where strands live in the buffers. Threads that share a rod, and
// velocities of springs in buffers, are Vulkan's.
#if HAIR_RODS
#define HAIR_VELOCITIES_REGISTER u6
#define HAIR_GATHERED_REGISTER u8
#elif HAIR_STORAGE == 2
#define HAIR_VELOCITIES_REGISTER u8
#define HAIR_GATHERED_REGISTER u6
#else
#define HAIR_VELOCITIES_REGISTER u7
#define HAIR_GATHERED_REGISTER u6
#endif

#if HAIR_BEND == 1
StructuredBuffer<float> gStiffness : register(t2);
#elif HAIR_BEND == 2
// Inverse diagonal, lower1, lower2, stiffness; for lanes a plane for each step of solveBend(), then one of what it ends
// with and the stiffness.
StructuredBuffer<float4> gFactors : register(t2);
#if HAIR_STORAGE == 3
// Steps in which pairs of points are told to all pairs.
#if HAIR_POINTS <= 4
#define BEND_STEPS 1
#elif HAIR_POINTS <= 8
#define BEND_STEPS 2
#elif HAIR_POINTS <= 16
#define BEND_STEPS 3
#elif HAIR_POINTS <= 32
#define BEND_STEPS 4
#else
#define BEND_STEPS 5
#endif
#endif
#endif
#if HAIR_TARGETS
StructuredBuffer<float4> gTargets : register(t3);
#endif
#if HAIR_SLEEP
RWStructuredBuffer<float> gRests : register(u2);     // see HAIRLOOM_REST_NUMBERS
#endif
#if HAIR_SLEEP && (HAIR_STORAGE >= 3 || HAIR_MEMBERS > 1)
RWStructuredBuffer<uint> gGathered : register(HAIR_GATHERED_REGISTER);  // per block: of its work groups, see shared_block.hlsli
#endif
#if HAIR_VELOCITIES
RWStructuredBuffer<float4> gVelocities : register(HAIR_VELOCITIES_REGISTER);  // m/s, in the caller's order
#endif

static uint gSlot;
/// Seen from the origin of this frame. Where that moves nothing sleeps, so that all roots are written anew.
float rootRow(uint row) { return gRoots[row * gFrame.slots + gSlot] + gFrame.originShift[min(row, 3u)]; }
#if HAIR_EXACT
#define POINTS HAIR_POINTS
#else
static uint gPointCount;
#define POINTS gPointCount
#endif
// Microsoft's compiler takes minutes to unroll a strand that meets spheres; drivers unroll what it leaves.
#if HAIR_UNROLL && !defined(HAIRLOOM_DXBC)
#define EACH [unroll]
#else
#define EACH [loop]
#endif
#define FIRST_FREE HAIR_CLAMPED
#if HAIR_STORAGE != 3
// What concerns each point of a strand, whoever it is done by. Places and displacements go by the index of a point among
// those of the thread, here all of its strand.
#define ALL_POINTS(p) EACH for (uint p = 0; p < POINTS; ++p)
#define FREE_POINTS(p) EACH for (uint p = FIRST_FREE; p < POINTS; ++p)
// Likewise, with others among them: those have no freedom(), and setFreePosition() and setFreePrevious() leave them.
#define MOVED_POINTS(p) FREE_POINTS(p)
#define freedom(p) 1.0
#define setFreePosition setPosition
#define setFreePrevious setPrevious
#define ONLY_POINT(n) ALONE
uint pointOf(uint k) { return k; }
uint ownOf(uint p) { return p; }
#endif

/// What the strand goes through in the frame.
static float3 gRoot;        // at the start of the frame, world
static float3 gRootDisplacement;    // its displacement in one substep
static uint gSubstep;

uint slotOf(uint plane, uint p) {
#if HAIR_TOGETHER
    return (plane * gFrame.slots + gSlot) * HAIR_POINTS + p;
#else
    return (plane * HAIR_POINTS + p) * gFrame.slots + gSlot;
#endif
}

#define BUFFER_ARRAY(type, get, put, buffer, plane) \
    float3 get(uint p) { return float3(buffer[slotOf(plane, p)], buffer[slotOf(plane + 1, p)], buffer[slotOf(plane + 2, p)]); } \
    void put(uint p, float3 v) { buffer[slotOf(plane, p)] = v.x; buffer[slotOf(plane + 1, p)] = v.y; buffer[slotOf(plane + 2, p)] = v.z; }
#ifdef HAIRLOOM_DXBC
// Where a loop's counter is the index, and its next value is known before the store, as Microsoft's compiler has it, Mesa's
// llvmpipe (22.3) stores at the next value. What is computed from the counter it keeps.
#define INDEX(p) min(p, HAIR_POINTS - 1u)
#else
#define INDEX(p) p
#endif
#define LOCAL_ARRAY(type, get, put, name) \
    static type name[HAIR_POINTS]; \
    type get(uint p) { return name[INDEX(p)]; } \
    void put(uint p, type v) { name[INDEX(p)] = v; }

BUFFER_ARRAY(float3, savedPosition, savePosition, gState, 0)
BUFFER_ARRAY(float3, savedPrevious, savePrevious, gState, 3)
#if HAIR_TENSIONS
float savedTension(uint p) { return gState[slotOf(6, p)]; }
void saveTension(uint p, float v) { gState[slotOf(6, p)] = v; }
#endif

#if HAIR_STORAGE == 2
#define position savedPosition
#define setPosition savePosition
#define previous savedPrevious
#define setPrevious savePrevious
#define tension savedTension
#define setTension saveTension
RWStructuredBuffer<float> gScratch : register(u7);
#define SCRATCH_ARRAY(get, put, name, plane) BUFFER_ARRAY(float3, get, put, gScratch, plane)
float upper(uint p) { return gScratch[slotOf(3, p)]; }
void setUpper(uint p, float v) { gScratch[slotOf(3, p)] = v; }
float right(uint p) { return gScratch[slotOf(4, p)]; }
void setRight(uint p, float v) { gScratch[slotOf(4, p)] = v; }
#elif HAIR_STORAGE == 3
#include "lanes.hlsli"
#else
#if HAIR_STORAGE == 4
#define HAIR_THREADS HAIRLOOM_WISP_THREADS
#endif
#if HAIR_STORAGE == 1 || HAIR_STORAGE == 4
groupshared float gShared[6 * HAIR_POINTS * HAIR_STRANDS];
static uint gStrand;  // in the work group
uint sharedSlot(uint plane, uint p) { return (plane * HAIR_POINTS + p) * HAIR_STRANDS + gStrand; }
float3 position(uint p) { return float3(gShared[sharedSlot(0, p)], gShared[sharedSlot(1, p)], gShared[sharedSlot(2, p)]); }
void setPosition(uint p, float3 v) { gShared[sharedSlot(0, p)] = v.x; gShared[sharedSlot(1, p)] = v.y; gShared[sharedSlot(2, p)] = v.z; }
float3 previous(uint p) { return float3(gShared[sharedSlot(3, p)], gShared[sharedSlot(4, p)], gShared[sharedSlot(5, p)]); }
void setPrevious(uint p, float3 v) { gShared[sharedSlot(3, p)] = v.x; gShared[sharedSlot(4, p)] = v.y; gShared[sharedSlot(5, p)] = v.z; }
#else
LOCAL_ARRAY(float3, position, setPosition, gPositions)
LOCAL_ARRAY(float3, previous, setPrevious, gPreviouses)
#endif
#if HAIR_TENSIONS
LOCAL_ARRAY(float, tension, setTension, gTension)
#endif
#define SCRATCH_ARRAY(get, put, name, plane) LOCAL_ARRAY(float3, get, put, name)
LOCAL_ARRAY(float, upper, setUpper, gUpper)
LOCAL_ARRAY(float, right, setRight, gRight)
#endif

#if HAIR_STORAGE != 3
/// Pulls of angular springs, and what holds segments: never both at once.
SCRATCH_ARRAY(work, setWork, gWork, 0)
#define INNER_POSITIONS
#define INNER_POSITION(p) position(p - 1)
#endif
// Of integrators that evaluate forces elsewhere than at the last position; displacements in one substep but for
// `start`, a position.
#if HAIR_EVALUATION >= 1
SCRATCH_ARRAY(start, setStart, gStarts, 5)
SCRATCH_ARRAY(stepDisplacement, setStepDisplacement, gStepDisplacements, 8)
#endif
#if HAIR_EVALUATION == 2
SCRATCH_ARRAY(kick, setKick, gKicks, 11)
SCRATCH_ARRAY(sum, setSum, gSums, 14)
SCRATCH_ARRAY(stepDisplacementSum, setStepDisplacementSum, gStepDisplacementSums, 17)
#elif HAIR_EVALUATION == 3
// Of the system of coil springs (implicit.hlsli): the inverse of each block of D, and the rows of that of L.
SCRATCH_ARRAY(inverseFirst, setInverseFirst, gInverseFirst, 11)
SCRATCH_ARRAY(inverseRest, setInverseRest, gInverseRest, 14)
SCRATCH_ARRAY(lowerX, setLowerX, gLowerX, 17)
SCRATCH_ARRAY(lowerY, setLowerY, gLowerY, 20)
SCRATCH_ARRAY(lowerZ, setLowerZ, gLowerZ, 23)
#endif

float3 restVector(uint p) { return gRest[slotOf(0, p)].xyz; }
float segmentLength(uint p) { return gSegments[slotOf(0, p)].x; }
float inverseMass(uint p) { return gSegments[slotOf(0, p)].y; }
/// 0 for a segment without length.
float inverseOf(float size) { return size > 1e-9 ? 1.0 / size : 0.0; }
float inverseLength(uint p) { return inverseOf(segmentLength(p)); }
#if HAIR_BEND == 1
float stiffness(uint p) { return gStiffness[slotOf(0, p)]; }
#elif HAIR_BEND == 2 && HAIR_STORAGE == 3
float stiffness(uint p) { return gFactors[slotOf(BEND_STEPS, p)].z; }
#elif HAIR_BEND == 2
float stiffness(uint p) { return gFactors[slotOf(0, p)].w; }
#endif
#if HAIR_TARGETS
float3 target(uint p) { return gTargets[slotOf(0, p)].xyz; }
#endif
