// SPDX-License-Identifier: MIT
// Leads curves between points of drawn hair out of a body, and what that has drawn in; a thread for each hair of which push_look has
// found some.
#include "push.hlsli"

/// A point has moved: curves around it are other ones.
void moved(uint p, uint first, uint end) {
    const uint from = max(p, first + 2u) - 2u, to = min(p + 1u, end - 1u);
    [loop] for (uint c = from; c <= to; ++c) gMarks[c] |= PUSH_CURVE;
}

void liftPoints(uint first, uint end) {
    [loop] for (uint p = first + 1u; p < end; ++p) {
        if ((gMarks[p] & PUSH_POINT) == 0u) continue;
        gMarks[p] &= ~PUSH_POINT;
        if (liftPoint(p)) moved(p, first, end);
    }
}

/// Whether something was moved.
bool liftCurve(uint first, uint end) {
    bool lifted = false;
    [loop] for (uint p = first; p + 1u < end; ++p) {
        if ((gMarks[p] & PUSH_CURVE) == 0u) continue;
        gMarks[p] &= ~PUSH_CURVE;
        [loop] for (uint place = 0; place < 3u; ++place) {
            // Roots stay, and what is next to them.
            if (p == first && place == 0u) continue;
            const PushCurve curve = curveAt(p, first, end);
            const float4 shares = sharesOf(place);
            const float3 at = placeOf(curve, shares);
            if (!isSound(at) || freeAround(at) > HAIRLOOM_PUSH_KEPT) continue;
            const BodyContact contact = bodyContact(gBody.steps, at);
            const float least = gLeastBetween[3u * p + place];
            if (!(contact.distance < least - HAIRLOOM_PUSH_SLACK)) continue;
            const float share = p == first ? shares.z : shares.y + shares.z;
            float3 lift = contact.normal * ((least - contact.distance) / share);
            // Never farther than the points are from each other.
            const float3 way = curve.b - curve.a;
            const float size = sqrt(dot(lift, lift)), along = sqrt(dot(way, way));
            if (size > along) lift *= along / size;
            if (p > first) {
                gPoints[p] = float4(curve.a + lift, 1.0);
                gMarks[p] |= PUSH_POINT;
                moved(p, first, end);
            }
            gPoints[p + 1u] = float4(curve.b + lift, 1.0);
            gMarks[p + 1u] |= PUSH_POINT;
            moved(p + 1u, first, end);
            lifted = true;
        }
    }
    return lifted;
}

[numthreads(HAIRLOOM_PUSH_GROUP, 1, 1)]
void main(uint3 thread : SV_DispatchThreadID) {
    const uint hair = thread.y * (65535u * HAIRLOOM_PUSH_GROUP) + thread.x;
    if (hair >= gPush.hairs || gFlags[hair] == 0u) return;
    gFlags[hair] = 0u;
    const uint first = gOffsets[hair], end = gOffsets[hair + 1u];
    // What was led out may have drawn what is beside it in.
    [loop] for (uint round = 0; round < HAIRLOOM_PUSH_ROUNDS; ++round) {
        if (round > 0u) liftPoints(first, end);
        if (!liftCurve(first, end)) break;
    }
}
