// SPDX-License-Identifier: MIT
// HAIR_STORAGE 3: a strand spread over the threads of a work group, HAIR_PER_THREAD points in each. What a point has stays
// in the registers of its thread; what others want to know of it the thread tells. Threads tell, and barriers stand, where all
// come by alike, whatever their strand does: one that sleeps has left before. They tell no more often, and no more is kept in
// registers and in the memory of the group, than has to be: the less of either, the more groups run side by side.

#define POINTS_PER_THREAD HAIR_PER_THREAD
#define STRAND_THREADS (HAIR_POINTS / POINTS_PER_THREAD)
#define HAIR_THREADS (STRAND_THREADS * HAIR_STRANDS)

static uint gThread;    // of the strand's; its points may lie past the strand's last one where strands share a batch
static uint gThreadInGroup;
static uint gLane;      // in the wave, with HAIR_WAVE, else in the work group
static uint gFirst;     // lane of the strand's first point
static uint gInner;     // lane of the points before, or this one's own
static uint gOuter;     // lane of the points after, or this one's own
static uint gStrand;    // in the work group

// k counts the thread's own points.
#define EACH_OWN_POINT(k) [unroll] for (uint k = 0; k < POINTS_PER_THREAD; ++k)
uint pointOf(uint k) { return gThread * POINTS_PER_THREAD + k; }
uint ownOf(uint p) { return p % POINTS_PER_THREAD; }
#define ALL_POINTS(k) EACH_OWN_POINT(k) if (pointOf(k) < POINTS)
#define FREE_POINTS(k) EACH_OWN_POINT(k) if (isFree(k))
// The others too, without branches, so that points go side by side; storage.hlsli has the same.
#define MOVED_POINTS(k) EACH_OWN_POINT(k)
#define ONLY_POINT(n) if (gThread == (n) / POINTS_PER_THREAD)

typedef float4 Float4s[POINTS_PER_THREAD];
/// The lane of the strand's thread so many after this one; this one's own beyond the ends.
uint laneAway(int away) {
    const int thread = int(gThread) + away;
    return thread < 0 || thread >= int(STRAND_THREADS) ? gLane : uint(int(gLane) + away);
}
/// The thread, counted from a point's own, in which the point `away` from the thread's first is, and which of its own it is.
int lanesAway(int away) { return (away + 64 * POINTS_PER_THREAD) / POINTS_PER_THREAD - 64; }
uint pointAway(int away) { return uint(away + 64 * POINTS_PER_THREAD) % POINTS_PER_THREAD; }

// What threads tell each other. With HAIR_WAVE a strand is in one wave of so many threads, which read each other's registers,
// all of them at a time; else it goes through the memory of the group.
#if HAIR_WAVE
static Float4s gExchange, gExchangeSecond;

void exchange(float4 what[POINTS_PER_THREAD]) { gExchange = what; }
void exchange(float4 what[POINTS_PER_THREAD], float4 too[POINTS_PER_THREAD]) {
    gExchange = what;
    gExchangeSecond = too;
}
void exchangeFirst(float4 what) { gExchange[0] = what; }
void exchangeLast(float4 what) { gExchange[POINTS_PER_THREAD - 1] = what; }
float4 ofOwn(float4 what[POINTS_PER_THREAD], uint k) { return k == 0 ? what[0] : what[POINTS_PER_THREAD - 1]; }
float4 loadPoint(uint p) { return WaveReadLaneAt(ofOwn(gExchange, p % POINTS_PER_THREAD), gFirst + p / POINTS_PER_THREAD); }
float4 loadPointSecond(uint p) { return WaveReadLaneAt(ofOwn(gExchangeSecond, p % POINTS_PER_THREAD), gFirst + p / POINTS_PER_THREAD); }
float4 loadNeighbour(int away) { return WaveReadLaneAt(gExchange[pointAway(away)], laneAway(lanesAway(away))); }
float4 loadInner() { return WaveReadLaneAt(gExchange[POINTS_PER_THREAD - 1], gInner); }
float4 loadOuter() { return WaveReadLaneAt(gExchange[0], gOuter); }
float4 loadInnerSecond() { return WaveReadLaneAt(gExchangeSecond[POINTS_PER_THREAD - 1], gInner); }
float4 loadOuterSecond() { return WaveReadLaneAt(gExchangeSecond[0], gOuter); }
float4 loadLast(int threads) { return WaveReadLaneAt(gExchange[POINTS_PER_THREAD - 1], laneAway(threads)); }

/// Whether it holds in any thread of those that wait for each other; mostly in none.
bool anyLane(bool own) { return WaveActiveAnyTrue(own); }
#else
// The two sides take turns, so that a thread may tell anew while others still read what it told last; what is seldom told
// too has one side, and a barrier before it.
groupshared float4 gExchange[2 * POINTS_PER_THREAD * HAIR_THREADS];
groupshared float4 gExchangeSecond[POINTS_PER_THREAD * HAIR_THREADS];
static uint gSide;

void turnSides() { gSide = POINTS_PER_THREAD * HAIR_THREADS - gSide; }
void exchange(float4 what[POINTS_PER_THREAD]) {
    turnSides();
    EACH_OWN_POINT(k) gExchange[gSide + k * HAIR_THREADS + gLane] = what[k];
    GroupMemoryBarrierWithGroupSync();
}
void exchange(float4 what[POINTS_PER_THREAD], float4 too[POINTS_PER_THREAD]) {
    GroupMemoryBarrierWithGroupSync();
    turnSides();
    EACH_OWN_POINT(k) {
        gExchange[gSide + k * HAIR_THREADS + gLane] = what[k];
        gExchangeSecond[k * HAIR_THREADS + gLane] = too[k];
    }
    GroupMemoryBarrierWithGroupSync();
}
/// Of the thread's first point alone, or of its last.
void exchangeFirst(float4 what) {
    turnSides();
    gExchange[gSide + gLane] = what;
    GroupMemoryBarrierWithGroupSync();
}
void exchangeLast(float4 what) {
    turnSides();
    gExchange[gSide + (POINTS_PER_THREAD - 1) * HAIR_THREADS + gLane] = what;
    GroupMemoryBarrierWithGroupSync();
}
uint laneOf(uint p) { return (p % POINTS_PER_THREAD) * HAIR_THREADS + gFirst + p / POINTS_PER_THREAD; }
/// What point p of the strand told, the same for all threads of the strand.
float4 loadPoint(uint p) { return gExchange[gSide + laneOf(p)]; }
float4 loadPointSecond(uint p) { return gExchangeSecond[laneOf(p)]; }
/// What the point `away` from the thread's first told, or, beyond the ends, any.
float4 loadNeighbour(int away) { return gExchange[gSide + pointAway(away) * HAIR_THREADS + laneAway(lanesAway(away))]; }
/// What the point before the thread's first told, and that after its last.
float4 loadInner() { return gExchange[gSide + (POINTS_PER_THREAD - 1) * HAIR_THREADS + gInner]; }
float4 loadOuter() { return gExchange[gSide + gOuter]; }
float4 loadInnerSecond() { return gExchangeSecond[(POINTS_PER_THREAD - 1) * HAIR_THREADS + gInner]; }
float4 loadOuterSecond() { return gExchangeSecond[gOuter]; }
/// What the last point of the thread so many after this one told; this one's own beyond the ends.
float4 loadLast(int threads) { return gExchange[gSide + (POINTS_PER_THREAD - 1) * HAIR_THREADS + laneAway(threads)]; }

groupshared uint gLastAsked[2];  // when one of the group's threads last said yes; the two take turns
static uint gAsked;
/// Whether it holds in any thread of those that wait for each other; mostly in none.
bool anyLane(bool own) {
    ++gAsked;
    if (own) gLastAsked[gAsked & 1u] = gAsked;
    GroupMemoryBarrierWithGroupSync();
    return gLastAsked[gAsked & 1u] == gAsked;
}
#endif
#define INNER_OF(own, k, before) ((k) == 0 ? (before) : (own)[(k) == 0 ? 0 : (k) - 1])
#define OUTER_OF(own, k, after) ((k) + 1 == POINTS_PER_THREAD ? (after) : (own)[(k) + 1 == POINTS_PER_THREAD ? 0 : (k) + 1])

/// Sums over the threads of the strand.
float2 sumOfStrand(float2 own) {
#if HAIR_WAVE
    [unroll] for (uint bit = 0; bit < 6; ++bit) {
        if (STRAND_THREADS >> bit > 1) own += WaveReadLaneAt(own, gLane ^ (1u << bit));
    }
    return own;
#else
    exchangeLast(float4(own, 0, 0));
    float2 sum = float2(0, 0);
    EACH for (uint t = 0; t < STRAND_THREADS; ++t) sum += loadPoint(t * POINTS_PER_THREAD + POINTS_PER_THREAD - 1).xy;
    return sum;
#endif
}

#define LANE_VALUE(type, get, put, name) \
    static type name[POINTS_PER_THREAD]; \
    type get(uint k) { return name[k]; } \
    void put(uint k, type v) { name[k] = v; }

LANE_VALUE(float3, position, setPosition, gPosition)
LANE_VALUE(float3, previous, setPrevious, gPrevious)
#if HAIR_TENSIONS
LANE_VALUE(float, tension, setTension, gTension)
#endif
#define SCRATCH_ARRAY(get, put, name, plane) LANE_VALUE(float3, get, put, name)

/// Of vectors of the thread's points.
Float4s toFloat4s(float3 v[POINTS_PER_THREAD]) {
    Float4s quads;
    EACH_OWN_POINT(k) quads[k] = float4(v[k], 0);
    return quads;
}

/// Places of all points.
void exchangePositions() { exchange(toFloat4s(gPosition)); }
#define INNER_POSITIONS \
    exchangeLast(float4(gPosition[POINTS_PER_THREAD - 1], 0)); \
    const float3 positionBefore = loadInner().xyz;
#define INNER_POSITION(k) INNER_OF(gPosition, k, positionBefore)

// Of the thread's own points and segments, read once a frame.
static float gLength[POINTS_PER_THREAD], gInverseLength[POINTS_PER_THREAD], gInverseMass[POINTS_PER_THREAD];
static float gInverseLengthBefore, gInverseMassAfter;
#if HAIR_BEND
static float gStiff[POINTS_PER_THREAD];
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
