// SPDX-License-Identifier: MIT
// Which curves between points of drawn hair are too deep in a body; a thread for each point.
#include "push.hlsli"

StructuredBuffer<uint> gHairs : register(t3);  // of each point, its hair

/// Whether the curve from point p on is too deep somewhere.
bool isTooDeep(uint p, uint first, uint end) {
    const PushCurve curve = curveAt(p, first, end);
    const float3 way = curve.b - curve.a, left = curve.a - curve.before, right = curve.b - curve.after;
    // No place of the curve is farther from both ends together.
    const float beside = sqrt(dot(left, left)) + sqrt(dot(right, right));
    const float farthest = 1.001 * (sqrt(dot(way, way)) + HAIRLOOM_PUSH_BOW * beside) + 2.0 * HAIRLOOM_PUSH_KEPT;
    if (isSound(curve.a) && isSound(curve.b) && freeAround(curve.a) + freeAround(curve.b) > farthest) return false;
    bool deep = false;
    [loop] for (uint place = 0; place < 3u && !deep; ++place) {
        // Roots stay, and what is next to them.
        if (p == first && place == 0u) continue;
        const float3 at = placeOf(curve, sharesOf(place));
        if (!isSound(at) || freeAround(at) > HAIRLOOM_PUSH_KEPT) continue;
        deep = bodyContact(gBody.steps, at).distance < gLeastBetween[3u * p + place] - HAIRLOOM_PUSH_SLACK;
    }
    return deep;
}

[numthreads(HAIRLOOM_PUSH_GROUP, 1, 1)]
void main(uint3 thread : SV_DispatchThreadID) {
    const uint p = thread.y * (65535u * HAIRLOOM_PUSH_GROUP) + thread.x;
    if (p >= gPush.points) return;
    const uint hair = gHairs[p], first = gOffsets[hair], end = gOffsets[hair + 1u];
    uint marks = 0u;
    if (p + 1u < end && isTooDeep(p, first, end)) marks = PUSH_CURVE;
    gMarks[p] = marks;
    if (marks != 0u) InterlockedOr(gFlags[hair], 1u);
}
