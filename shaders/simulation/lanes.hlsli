// SPDX-License-Identifier: MIT
// HAIR_STORAGE 3: a strand spread over the lanes of a work group, a lane for each point. What a point has stays in
// the registers of its lane; what others want to know of it the lane tells through the memory of the group. Barriers
// stand where all lanes come by alike, whatever their strand does: one that sleeps has left before. They are told no more
// often, and no more is kept there, than has to be: the less memory groups have, the more of them run side by side. With
// HAIR_TABLES, for as few strands as all run at once, the memory also has what lanes would each compute for themselves.

#define HAIR_THREADS (HAIR_POINTS * HAIR_STRANDS)

static uint gPoint;     // of this lane; past the strand's last one where strands share a batch
static uint gLane;      // in the work group
static uint gFirst;     // lane of the strand's first point
static uint gInner;     // lane of the point before, or this one's own
static uint gOuter;     // lane of the point after, or this one's own
static uint gStrand;    // in the work group

#define OWN_POINT if (gPoint < POINTS)
#define ALL_POINTS(p) const uint p = gPoint; if (p < POINTS)
#define FREE_POINTS(p) const uint p = gPoint; if (p >= FIRST_FREE && p < POINTS)
#define ONLY_POINT(n) if (gPoint == n)

// The two sides take turns, so that a lane may tell anew while others still read what it told last; what is seldom told too
// has one side and a barrier more.
groupshared float4 gTold[2 * HAIR_THREADS];
groupshared float4 gToldToo[HAIR_THREADS];
static uint gSide;

void tell(float4 what) {
    gSide = HAIR_THREADS - gSide;
    gTold[gSide + gLane] = what;
    GroupMemoryBarrierWithGroupSync();
}
void tell(float4 what, float4 too) {
    GroupMemoryBarrierWithGroupSync();
    gSide = HAIR_THREADS - gSide;
    gTold[gSide + gLane] = what;
    gToldToo[gLane] = too;
    GroupMemoryBarrierWithGroupSync();
}
/// What point p of the strand told.
float4 told(uint p) { return gTold[gSide + gFirst + p]; }
float4 toldToo(uint p) { return gToldToo[gFirst + p]; }
float4 toldInner() { return gTold[gSide + gInner]; }
float4 toldOuter() { return gTold[gSide + gOuter]; }
float4 toldTooInner() { return gToldToo[gInner]; }
float4 toldTooOuter() { return gToldToo[gOuter]; }

groupshared uint gFirstOfStrand[HAIR_STRANDS];
/// The first point of the strand of which it holds; past the last one where there is none.
uint firstOfStrand(bool holds) {
    if (gPoint == 0) gFirstOfStrand[gStrand] = 0xffffffffu;
    GroupMemoryBarrierWithGroupSync();
    if (holds) InterlockedMin(gFirstOfStrand[gStrand], gPoint);
    GroupMemoryBarrierWithGroupSync();
    return gFirstOfStrand[gStrand];
}

/// Sums over the points of the strand.
float2 sumOfStrand(float2 own) {
    tell(float4(own, 0, 0));
    float2 sum = float2(0, 0);
    EACH for (uint p = 0; p < HAIR_POINTS; ++p) sum += told(p).xy;
    return sum;
}

// p is the lane's own point.
#define LANE_VALUE(type, get, put, name) \
    static type name; \
    type get(uint p) { return name; } \
    void put(uint p, type v) { name = v; }

LANE_VALUE(float3, position, setPosition, gPosition)
LANE_VALUE(float3, previous, setPrevious, gPrevious)
#if HAIR_CURVES
LANE_VALUE(float3, curve, setCurve, gCurve)
#endif
#if HAIR_TENSIONS
LANE_VALUE(float, tension, setTension, gTension)
#endif
#define SCRATCH_ARRAY(get, put, name, plane) LANE_VALUE(float3, get, put, name)

/// Places of other points.
void tellPositions() { tell(float4(gPosition, 0)); }
#define INNER_POSITIONS \
    tellPositions(); \
    const float3 innerPosition = toldInner().xyz;
#define INNER_POSITION(p) innerPosition

// Of the lane's own point and segment, read once a frame.
static float gLength, gInverseLength, gInnerInverseLength, gInverseMass, gOuterInverseMass;
#if HAIR_BEND
static float gStiff;
#endif
#if HAIR_TARGETS
static float3 gTarget;
#endif
#if HAIR_BEND == 2
static float4 gReduction[BEND_STEPS];  // see solveBend()
static float2 gReduced;
#endif

bool hasSegment() { return gPoint + 1 < POINTS; }
bool isFree() { return gPoint >= FIRST_FREE && gPoint < POINTS; }
/// A joint stands between the segments before and after each point but the clamped ones' inner.
bool hasJoint() { return gPoint + 1 >= FIRST_FREE && gPoint + 1 < POINTS; }
