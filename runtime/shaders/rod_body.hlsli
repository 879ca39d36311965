// SPDX-License-Identifier: MIT
// The planes that stand for a body, for nodes of a rod (docs/engine.md, "Bodies"), as models/rods/rod_search-inl.h. What that keeps
// from frame to frame to leave far nodes alone is not kept here: a table of distances says as soon how far they are.
#include "body.hlsli"

StructuredBuffer<float> gClearances : register(t12);  // of each point, metres from the body at rest

#define BODY_PLANE (HAIRLOOM_ROD_WORK_PLANES + HAIRLOOM_ROD_CONTACT_PLANES)
BUFFER_ARRAY(float3, planeNormal, setPlaneNormal, gScratch, BODY_PLANE)
BUFFER_ARRAY(float3, planeWay, setPlaneWay, gScratch, BODY_PLANE + 5)
BUFFER_ARRAY(float3, planeAt, setPlaneAt, gScratch, BODY_PLANE + 12)
BUFFER_ARRAY(float3, planeMoved, setPlaneMoved, gScratch, BODY_PLANE + 15)
BUFFER_ARRAY(float3, foldNormal, setFoldNormal, gScratch, BODY_PLANE + 18)
#define BODY_NUMBER(get, put, plane) \
    float get(uint p) { return gScratch[slotOf(BODY_PLANE + plane, p)]; } \
    void put(uint p, float v) { gScratch[slotOf(BODY_PLANE + plane, p)] = v; }
BODY_NUMBER(planeDistance, setPlaneDistance, 3)  // metres, at planeAt()
BODY_NUMBER(planeBefore, setPlaneBefore, 4)
BODY_NUMBER(planeKnown, setPlaneKnown, 8)  // 1 where it is of this substep
BODY_NUMBER(planeRoom, setPlaneRoom, 9)    // metres that the node may go beyond planeMoved() and touch nothing
BODY_NUMBER(planeMeets, setPlaneMeets, 10)  // 1 where it holds for the guess that was searched last
BODY_NUMBER(planeLevel, setPlaneLevel, 11)  // metres from it of a node that would not move in the substep
BODY_NUMBER(foldLevel, setFoldLevel, 21)    // the same of the other plane, where skin folds

/// Metres that node p keeps from the body: its radius, but no more than it was authored from it.
float bodyReach(uint p) { return min(collisionRadiusAt(p), gClearances[slotOf(0, p)]); }

/// Nothing is known of the body beside node p in this substep.
void forgetPlane(uint p) {
    setPlaneKnown(p, 0.0);
    setPlaneMeets(p, 0.0);
    setPlaneRoom(p, 0.0);
    setPlaneMoved(p, float3(0, 0, 0));
}

/// Whether a plane of folded skin that was found before holds a node beside the one with `normal`.
bool isOtherFold(float3 normal, float distance, float3 moved, float4 fold) {
    const float ahead = dot(normal, fold.xyz);
    // In a gap that is narrower than the node is wide both sides push it, towards each other.
    const bool between = distance > 0.0 && fold.w + dot(fold.xyz, moved) > 0.0;
    return (ahead > HAIRLOOM_BODY_FOLDS_BACK || between) && ahead < HAIRLOOM_BODY_FOLDS_AHEAD && dot(fold.xyz, fold.xyz) > 0.0;
}
bool isSlowWay(float3 way) {
    const float slow = HAIRLOOM_ROD_CONTACT_SLOW * gFrame.h;
    return dot(way, way) < slow * slow;
}

/// The other plane of a node beside one that was found with this normal: one that pressed it in the look before or in the last
/// substep, where the node is slow: then the skin folds there. 0: none.
float4 otherPlane(uint p, float3 normal, float distance, float3 way, float3 moved, float reach) {
    if (!isSlowWay(moved) || !isSlowWay(moved - way)) return float4(0, 0, 0, 0);
    if (planeKnown(p) > 0.0) {
        const float4 before = float4(planeNormal(p), planeLevel(p)), other = float4(foldNormal(p), foldLevel(p));
        if (planeDistance(p) < reach && isOtherFold(normal, distance, moved, before)) return before;
        if (isOtherFold(normal, distance, moved, other)) return other;
    }
    if (load(p) == 0.0) return float4(0, 0, 0, 0);
    [unroll] for (uint which = 0; which < 2u; ++which) {
        float4 kept = keptFold(which, p);
        // It goes with the skin that was found.
        kept.w -= dot(kept.xyz, way);
        if (isOtherFold(normal, distance, moved, kept)) return kept;
    }
    return float4(0, 0, 0, 0);
}

/// Finds the plane of node p, which the guess has at `position` from the root's place `origin`, moved by `moved`. In a substep the
/// plane that was found holds for all guesses that are close to where it was found, and for those that are outside for certain.
void findPlane(float3 origin, uint p, float3 position, float3 moved) {
    const float reach = bodyReach(p), margin = reach + HAIRLOOM_ROD_CONTACT_NEAR;
    if (planeKnown(p) > 0.0) {
        const float3 from = position - planeAt(p);
        const float gone = sqrt(dot(from, from));
        const bool kept = gone <= 1e-4 || negMad(gone, 1.25, planeDistance(p)) > reach + 1e-4;
        setPlaneMeets(p, kept ? 1.0 : 0.0);
        if (kept) return;
    }
    const uint step = gSubstep + 1u;
    const float3 position_ws = position + origin;
    BodyRoom room = roomAround(step, position_ws, moved);
    const float near = margin + room.against;
    float3 normal = float3(0, 1, 0), way = float3(0, 0, 0);
    float distance = 0.0, before = 0.0;
    bool met = false;
    if (room.free <= near) {
        // The way out at the end of the substep; where it was inside at the start whether it was, and if not, where it came in:
        // from place to place along its way, as far as nothing is, by the body as it is at the end (MovingBody::sweep()).
        uint look = 0u;
        float3 at_ws = position_ws, slid = float3(0, 0, 0);
        float gone = 0.0, whole = 0.0;
        [loop] for (uint turn = 0; turn < 18u; ++turn) {
            const BodyContact found = bodyContact(turn == 1u ? gSubstep : step, at_ws);
            if (turn == 0u) {
                if (found.distance >= BODY_NOWHERE) break;
                room.free = max(room.free, surelyFree(found.distance));
                if (found.distance > near) break;
                met = true;
                normal = found.normal;
                distance = found.distance;
                if (gBody.moves != 0u) way = position_ws - placed(poseNear(gSubstep, found.rest), found.rest);
                slid = moved - way;
                before = distance - dot(normal, slid);
                if (!(before < reach - HAIRLOOM_ROD_CONTACT_DEEP)) break;
                at_ws = position_ws - moved;
                continue;
            }
            if (turn == 1u) {
                before = min(found.distance, near);
                whole = sqrt(dot(slid, slid));
                // What lay on the skin is swept off it, too: far inside, the nearest way out may be on the other side.
                const float depth = reach - distance, inside = reach - before;
                if (!(depth > (inside > 0.0 ? 1e-3 : 0.0)) || inside > 3e-3 || !(whole > 0.0)) break;
            } else {
                if (found.distance >= BODY_NOWHERE) break;
                const float free = found.distance - reach;
                if (free < 1e-4) {
                    const float left = dot(found.normal, slid) * (1.0 - gone / whole);
                    // What leads out again is none that it came in by.
                    if (left < 0.0) {
                        normal = found.normal;
                        distance = found.distance + left;
                    }
                    break;
                }
                gone += free;
                if (gone >= whole) break;
            }
            at_ws = position_ws - slid * (1.0 - gone / whole);
        }
    }
    setPlaneRoom(p, room.free - reach);
    setPlaneMoved(p, moved);
    setPlaneMeets(p, met ? 1.0 : 0.0);
    if (!met) {
        setPlaneKnown(p, 0.0);
        return;
    }
    const float4 other = otherPlane(p, normal, distance, way, moved, reach);
    setFoldNormal(p, other.xyz);
    setFoldLevel(p, other.w);
    setPlaneAt(p, position);
    setPlaneNormal(p, normal);
    setPlaneDistance(p, distance);
    setPlaneBefore(p, before);
    setPlaneWay(p, way);
    setPlaneLevel(p, distance - dot(normal, moved));
    setPlaneKnown(p, 1.0);
}

/// Whether the outer node of a segment may touch the body where a guess has moved it by `moved`.
bool mayTouchBody(uint p, float3 moved) {
    const float3 since = moved - planeMoved(p);
    const float room = max(planeRoom(p), 0.0);
    return dot(since, since) > room * room;
}

/// The plane of node p as it holds the node (`which` 0), and the other one where skin folds (1); false: there is none.
bool touchOfBody(uint which, uint p, RodNode node, out RodTouch touch) {
    touch.normal = float3(0, 1, 0);
    touch.depth = touch.before = -1e3;
    touch.way = float3(0, 0, 0);
    if (!(planeMeets(p) > 0.0)) return false;
    const float reach = bodyReach(p);
    touch.normal = planeNormal(p);
    touch.way = planeWay(p);
    const float distance = planeDistance(p) + dot(node.position - planeAt(p), touch.normal);
    if (which == 0u) {
        touch.depth = min(reach - distance, HAIRLOOM_BODY_PUSH);
        touch.before = reach - planeBefore(p);
        return true;
    }
    touch.normal = foldNormal(p);
    const float level = foldLevel(p);
    touch.depth = min(reach - (level + dot(touch.normal, node.displacement)), HAIRLOOM_BODY_PUSH);
    touch.before = reach - (level + dot(touch.normal, touch.way));
    return dot(touch.normal, touch.normal) > 0.0 && distance < reach + HAIRLOOM_BODY_FOLD_REACH;
}

/// Metres by which a prediction may lift a node off what pressed it in the last substep: skin has folds and edges.
float bodySlackAfter(RodTouch touch, RodNode node) {
    const float slack = rodSlackAfter(node.load);
    const float back = min(abs(node.load) * HAIRLOOM_BODY_BACK / node.weight, HAIRLOOM_ROD_CONTACT_NEAR);
    return touch.before > -HAIRLOOM_ROD_CONTACT_DEEP ? max(slack, back) : slack;
}

/// Whether a node goes back and forth in slow substeps: across an edge of skin it could do so for ever.
bool goesBack(float3 moved, float3 last) {
    const float slow = HAIRLOOM_ROD_CONTACT_SLOW * gFrame.h, most = max(dot(moved, moved), dot(last, last));
    return most < slow * slow && dot(moved, last) < -0.5 * most;
}

/// Keeps the planes that press the outer node of a segment, for the next substep.
void keepFolds(uint p, float3 moved, bool pressed) {
    if (!pressed && load(p) == 0.0) return;
    const float reach = bodyReach(p) + HAIRLOOM_BODY_FOLD_REACH;
    float4 own = float4(0, 0, 0, 0), other = float4(0, 0, 0, 0);
    // A sphere may have pressed it, beside skin that did not.
    if (pressed && planeKnown(p) > 0.0) {
        const float3 normal = planeNormal(p), fold = foldNormal(p);
        const float away = planeLevel(p) + dot(normal, moved), otherAway = foldLevel(p) + dot(fold, moved);
        if (away < reach) own = float4(normal, away);
        if (otherAway < reach) other = float4(fold, otherAway);
    }
    keepFold(0u, p, own);
    keepFold(1u, p, other);
}
