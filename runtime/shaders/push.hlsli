// SPDX-License-Identifier: MIT
// What the kernels that lead drawn hair out of a body have, in their order push_points, push_look, push_hairs: runtime::BodyPush.
#include "math.hlsli"
#include "push_types.h"
#include "body.hlsli"

cbuffer Push : register(b0) { PushConstants gPush; };
StructuredBuffer<uint> gOffsets : register(t0);        // of each hair its first point; behind the last one the end
StructuredBuffer<float> gLeast : register(t1);         // of each point, metres that it keeps from the body
StructuredBuffer<float> gLeastBetween : register(t2);  // likewise three places on the way to the next point
RWStructuredBuffer<float4> gPoints : register(u0);     // world, w 1
RWStructuredBuffer<uint> gMarks : register(u1);        // of each point, what is to be looked at: PUSH_POINT, PUSH_CURVE
RWStructuredBuffer<uint> gFlags : register(u2);        // of each hair, not 0: something is

#define PUSH_POINT 1u
#define PUSH_CURVE 2u

float3 pointAt(uint p) { return gPoints[p].xyz; }
float freeAround(float3 at) { return roomAround(gBody.steps, at, float3(0, 0, 0)).free; }

/// Whether a point was too deep, and is led out along the way that leads out there, which is another one higher up.
bool liftPoint(uint p) {
    float3 at = pointAt(p);
    if (!isSound(at) || freeAround(at) > HAIRLOOM_PUSH_KEPT) return false;
    bool lifted = false;
    [loop] for (uint round = 0; round < HAIRLOOM_PUSH_POINT_ROUNDS; ++round) {
        const BodyContact contact = bodyContact(gBody.steps, at);
        if (!(contact.distance < gLeast[p] - HAIRLOOM_PUSH_SLACK)) break;
        at += contact.normal * (gLeast[p] - contact.distance);
        lifted = true;
    }
    if (lifted) gPoints[p] = float4(at, 1.0);
    return lifted;
}

/// Places of a uniform Catmull-Rom curve between two points, at ¼, ½ and ¾: shares of the points around.
float4 sharesOf(uint place) {
    if (place == 1u) return float4(-1.0, 9.0, 9.0, -1.0) / 16.0;
    return (place == 0u ? float4(-9.0, 111.0, 29.0, -3.0) : float4(-3.0, 29.0, 111.0, -9.0)) / 128.0;
}

/// The points around the way from p to the next one; missing neighbours repeat the ends.
struct PushCurve {
    float3 before, a, b, after;
};
PushCurve curveAt(uint p, uint first, uint end) {
    PushCurve curve;
    curve.a = pointAt(p);
    curve.b = pointAt(p + 1u);
    curve.before = curve.a;
    curve.after = curve.b;
    if (p > first) curve.before = pointAt(p - 1u);
    if (p + 2u < end) curve.after = pointAt(p + 2u);
    return curve;
}
float3 placeOf(PushCurve curve, float4 shares) {
    return curve.before * shares.x + curve.a * shares.y + curve.b * shares.z + curve.after * shares.w;
}
