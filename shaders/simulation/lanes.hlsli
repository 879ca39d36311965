// SPDX-License-Identifier: MIT
// HAIR_STORAGE 3: a strand spread over the threads of a work group, HAIR_PER_THREAD points in each. What a point has stays
// in the registers of its thread; what others want to know of it the thread tells through the memory of the group. Barriers
// stand where all threads come by alike, whatever their strand does: one that sleeps has left before. They are told no more
// often, and no more is kept there, than has to be: the less memory groups have, the more of them run side by side.

#define OWN HAIR_PER_THREAD
#define STRAND_THREADS (HAIR_POINTS / OWN)
#define HAIR_THREADS (STRAND_THREADS * HAIR_STRANDS)

static uint gThread;    // of the strand's; its points may lie past the strand's last one where strands share a batch
static uint gLane;      // in the work group
static uint gFirst;     // lane of the strand's first point
static uint gInner;     // lane of the points before, or this one's own
static uint gOuter;     // lane of the points after, or this one's own
static uint gStrand;    // in the work group

// k counts the thread's own points.
#define EACH_OWN(k) [unroll] for (uint k = 0; k < OWN; ++k)
uint pointOf(uint k) { return gThread * OWN + k; }
uint ownOf(uint p) { return p % OWN; }
#define ALL_POINTS(k) EACH_OWN(k) if (pointOf(k) < POINTS)
#define FREE_POINTS(k) EACH_OWN(k) if (isFree(k))
#define ONLY_POINT(n) if (gThread == (n) / OWN)

// The two sides take turns, so that a thread may tell anew while others still read what it told last; what is seldom told
// too has one side, and a barrier before it.
groupshared float4 gTold[2 * OWN * HAIR_THREADS];
groupshared float4 gToldToo[OWN * HAIR_THREADS];
static uint gSide;

void turnSides() { gSide = OWN * HAIR_THREADS - gSide; }
void tell(float4 what[OWN]) {
    turnSides();
    EACH_OWN(k) gTold[gSide + k * HAIR_THREADS + gLane] = what[k];
    GroupMemoryBarrierWithGroupSync();
}
void tell(float4 what[OWN], float4 too[OWN]) {
    GroupMemoryBarrierWithGroupSync();
    turnSides();
    EACH_OWN(k) {
        gTold[gSide + k * HAIR_THREADS + gLane] = what[k];
        gToldToo[k * HAIR_THREADS + gLane] = too[k];
    }
    GroupMemoryBarrierWithGroupSync();
}
/// Of the thread's first point alone, or of its last.
void tellFirst(float4 what) {
    turnSides();
    gTold[gSide + gLane] = what;
    GroupMemoryBarrierWithGroupSync();
}
void tellLast(float4 what) {
    turnSides();
    gTold[gSide + (OWN - 1) * HAIR_THREADS + gLane] = what;
    GroupMemoryBarrierWithGroupSync();
}
uint laneOf(uint p) { return (p % OWN) * HAIR_THREADS + gFirst + p / OWN; }
/// What point p of the strand told.
float4 told(uint p) { return gTold[gSide + laneOf(p)]; }
float4 toldToo(uint p) { return gToldToo[laneOf(p)]; }
/// What the point before the thread's first told, and that after its last.
float4 toldInner() { return gTold[gSide + (OWN - 1) * HAIR_THREADS + gInner]; }
float4 toldOuter() { return gTold[gSide + gOuter]; }
float4 toldTooInner() { return gToldToo[(OWN - 1) * HAIR_THREADS + gInner]; }
float4 toldTooOuter() { return gToldToo[gOuter]; }
#define INNER_OF(own, k, before) ((k) == 0 ? (before) : (own)[(k) == 0 ? 0 : (k) - 1])
#define OUTER_OF(own, k, after) ((k) + 1 == OWN ? (after) : (own)[(k) + 1 == OWN ? 0 : (k) + 1])

groupshared uint gLastAsked[2];  // when one of the group's threads last said yes; the two take turns
static uint gAsked;
/// Whether it holds in any thread of the work group; mostly in none.
bool anyOfGroup(bool own) {
    ++gAsked;
    if (own) gLastAsked[gAsked & 1u] = gAsked;
    GroupMemoryBarrierWithGroupSync();
    return gLastAsked[gAsked & 1u] == gAsked;
}

/// Sums over the threads of the strand.
float2 sumOfStrand(float2 own) {
    tellLast(float4(own, 0, 0));
    float2 sum = float2(0, 0);
    EACH for (uint t = 0; t < STRAND_THREADS; ++t) sum += told(t * OWN + OWN - 1).xy;
    return sum;
}

#define LANE_VALUE(type, get, put, name) \
    static type name[OWN]; \
    type get(uint k) { return name[k]; } \
    void put(uint k, type v) { name[k] = v; }

LANE_VALUE(float3, position, setPosition, gPosition)
LANE_VALUE(float3, previous, setPrevious, gPrevious)
#if HAIR_CURVES
LANE_VALUE(float3, curve, setCurve, gCurve)
#endif
#if HAIR_TENSIONS
LANE_VALUE(float, tension, setTension, gTension)
#endif
#define SCRATCH_ARRAY(get, put, name, plane) LANE_VALUE(float3, get, put, name)

typedef float4 Quads[OWN];
/// Of vectors of the thread's points.
Quads quadsOf(float3 v[OWN]) {
    Quads quads;
    EACH_OWN(k) quads[k] = float4(v[k], 0);
    return quads;
}

/// Places of all points.
void tellPositions() { tell(quadsOf(gPosition)); }
#define INNER_POSITIONS \
    tellLast(float4(gPosition[OWN - 1], 0)); \
    const float3 positionBefore = toldInner().xyz;
#define INNER_POSITION(k) INNER_OF(gPosition, k, positionBefore)

// Of the thread's own points and segments, read once a frame.
static float gLength[OWN], gInverseLength[OWN], gInverseMass[OWN];
static float gInverseLengthBefore, gInverseMassAfter;
#if HAIR_BEND
static float gStiff[OWN];
#endif
#if HAIR_TARGETS
static float3 gTarget[OWN];
#endif
#if HAIR_BEND == 2
static float4 gReduction[OWN * BEND_STEPS];  // see solveBend()
static float2 gReduced[OWN];
#endif
float innerInverseLength(uint k) { return INNER_OF(gInverseLength, k, gInverseLengthBefore); }
float outerInverseMass(uint k) { return OUTER_OF(gInverseMass, k, gInverseMassAfter); }

bool hasSegment(uint k) { return pointOf(k) + 1 < POINTS; }
bool isFree(uint k) { return pointOf(k) >= FIRST_FREE && pointOf(k) < POINTS; }
/// A joint stands between the segments before and after each point but the clamped ones' inner.
bool hasJoint(uint k) { return pointOf(k) + 1 >= FIRST_FREE && pointOf(k) + 1 < POINTS; }
