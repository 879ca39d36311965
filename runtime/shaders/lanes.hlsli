// SPDX-License-Identifier: MIT
// HAIR_STORAGE 3: a strand spread over the threads of a work group, HAIR_PER_THREAD points in each. What a point has stays
// in the registers of its thread; what others want to know of it the thread tells. Threads tell, and barriers stand, where all
// come by alike, whatever their strand does: one that sleeps has left before. They tell no more often, and no more is kept in
// registers and in the memory of the group, than has to be: the less of either, the more groups run side by side.

#define OWN HAIR_PER_THREAD
#define STRAND_THREADS (HAIR_POINTS / OWN)
#define HAIR_THREADS (STRAND_THREADS * HAIR_STRANDS)

static uint gThread;    // of the strand's; its points may lie past the strand's last one where strands share a batch
static uint gPlace;     // in the work group
static uint gLane;      // in the wave, with HAIR_WAVE, else in the work group
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
// The others too, without branches, so that points go side by side; storage.hlsli has the same.
#define MOVED_POINTS(k) EACH_OWN(k)
#define ONLY_POINT(n) if (gThread == (n) / OWN)

typedef float4 Quads[OWN];
/// The lane of the strand's thread so many after this one; this one's own beyond the ends.
uint laneAway(int away) {
    const int thread = int(gThread) + away;
    return thread < 0 || thread >= int(STRAND_THREADS) ? gLane : uint(int(gLane) + away);
}
/// The thread, counted from a point's own, in which the point `away` from the thread's first is, and which of its own it is.
int threadsAway(int away) { return (away + 64 * OWN) / OWN - 64; }
uint ownAway(int away) { return uint(away + 64 * OWN) % OWN; }

// What threads tell each other. With HAIR_WAVE a strand is in one wave of so many threads, which read each other's registers,
// all of them at a time; else it goes through the memory of the group.
#if HAIR_WAVE
static Quads gTold, gToldToo;

void tell(float4 what[OWN]) { gTold = what; }
void tell(float4 what[OWN], float4 too[OWN]) {
    gTold = what;
    gToldToo = too;
}
void tellFirst(float4 what) { gTold[0] = what; }
void tellLast(float4 what) { gTold[OWN - 1] = what; }
float4 ofOwn(float4 what[OWN], uint k) { return k == 0 ? what[0] : what[OWN - 1]; }
float4 told(uint p) { return WaveReadLaneAt(ofOwn(gTold, p % OWN), gFirst + p / OWN); }
float4 toldToo(uint p) { return WaveReadLaneAt(ofOwn(gToldToo, p % OWN), gFirst + p / OWN); }
float4 toldFrom(int away) { return WaveReadLaneAt(gTold[ownAway(away)], laneAway(threadsAway(away))); }
float4 toldInner() { return WaveReadLaneAt(gTold[OWN - 1], gInner); }
float4 toldOuter() { return WaveReadLaneAt(gTold[0], gOuter); }
float4 toldTooInner() { return WaveReadLaneAt(gToldToo[OWN - 1], gInner); }
float4 toldTooOuter() { return WaveReadLaneAt(gToldToo[0], gOuter); }
float4 toldLast(int threads) { return WaveReadLaneAt(gTold[OWN - 1], laneAway(threads)); }

/// Whether it holds in any thread of those that wait for each other; mostly in none.
bool anyOfThem(bool own) { return WaveActiveAnyTrue(own); }
#else
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
/// What point p of the strand told, the same for all threads of the strand.
float4 told(uint p) { return gTold[gSide + laneOf(p)]; }
float4 toldToo(uint p) { return gToldToo[laneOf(p)]; }
/// What the point `away` from the thread's first told, or, beyond the ends, any.
float4 toldFrom(int away) { return gTold[gSide + ownAway(away) * HAIR_THREADS + laneAway(threadsAway(away))]; }
/// What the point before the thread's first told, and that after its last.
float4 toldInner() { return gTold[gSide + (OWN - 1) * HAIR_THREADS + gInner]; }
float4 toldOuter() { return gTold[gSide + gOuter]; }
float4 toldTooInner() { return gToldToo[(OWN - 1) * HAIR_THREADS + gInner]; }
float4 toldTooOuter() { return gToldToo[gOuter]; }
/// What the last point of the thread so many after this one told; this one's own beyond the ends.
float4 toldLast(int threads) { return gTold[gSide + (OWN - 1) * HAIR_THREADS + laneAway(threads)]; }

groupshared uint gLastAsked[2];  // when one of the group's threads last said yes; the two take turns
static uint gAsked;
/// Whether it holds in any thread of those that wait for each other; mostly in none.
bool anyOfThem(bool own) {
    ++gAsked;
    if (own) gLastAsked[gAsked & 1u] = gAsked;
    GroupMemoryBarrierWithGroupSync();
    return gLastAsked[gAsked & 1u] == gAsked;
}
#endif
#define INNER_OF(own, k, before) ((k) == 0 ? (before) : (own)[(k) == 0 ? 0 : (k) - 1])
#define OUTER_OF(own, k, after) ((k) + 1 == OWN ? (after) : (own)[(k) + 1 == OWN ? 0 : (k) + 1])

/// Sums over the threads of the strand.
float2 sumOfStrand(float2 own) {
#if HAIR_WAVE
    [unroll] for (uint bit = 0; bit < 6; ++bit) {
        if (STRAND_THREADS >> bit > 1) own += WaveReadLaneAt(own, gLane ^ (1u << bit));
    }
    return own;
#else
    tellLast(float4(own, 0, 0));
    float2 sum = float2(0, 0);
    EACH for (uint t = 0; t < STRAND_THREADS; ++t) sum += told(t * OWN + OWN - 1).xy;
    return sum;
#endif
}

#define LANE_VALUE(type, get, put, name) \
    static type name[OWN]; \
    type get(uint k) { return name[k]; } \
    void put(uint k, type v) { name[k] = v; }

LANE_VALUE(float3, position, setPosition, gPosition)
LANE_VALUE(float3, previous, setPrevious, gPrevious)
#if HAIR_CURVES && HAIR_WAVE
// Wanted once a substep: in registers they would be in the way. Without waves the memory of the group is what is short.
groupshared float gHeldCurves[3 * OWN * HAIR_THREADS];
float3 curve(uint k) {
    const uint x = 3 * k * HAIR_THREADS + gPlace;
    return float3(gHeldCurves[x], gHeldCurves[x + HAIR_THREADS], gHeldCurves[x + 2 * HAIR_THREADS]);
}
void setCurve(uint k, float3 v) {
    const uint x = 3 * k * HAIR_THREADS + gPlace;
    gHeldCurves[x] = v.x;
    gHeldCurves[x + HAIR_THREADS] = v.y;
    gHeldCurves[x + 2 * HAIR_THREADS] = v.z;
}
#elif HAIR_CURVES
LANE_VALUE(float3, curve, setCurve, gCurve)
#endif
#if HAIR_TENSIONS
LANE_VALUE(float, tension, setTension, gTension)
#endif
#define SCRATCH_ARRAY(get, put, name, plane) LANE_VALUE(float3, get, put, name)

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
float innerInverseLength(uint k) { return INNER_OF(gInverseLength, k, gInverseLengthBefore); }
float outerInverseMass(uint k) { return OUTER_OF(gInverseMass, k, gInverseMassAfter); }

bool hasSegment(uint k) { return pointOf(k) + 1 < POINTS; }
bool isFree(uint k) { return pointOf(k) >= FIRST_FREE && pointOf(k) < POINTS; }
float freedom(uint k) { return isFree(k) ? 1.0 : 0.0; }
void setFreePosition(uint k, float3 v) { gPosition[k] = isFree(k) ? v : gPosition[k]; }
void setFreePrevious(uint k, float3 v) { gPrevious[k] = isFree(k) ? v : gPrevious[k]; }
/// A joint stands between the segments before and after each point but the clamped ones' inner.
bool hasJoint(uint k) { return pointOf(k) + 1 >= FIRST_FREE && pointOf(k) + 1 < POINTS; }
