// SPDX-License-Identifier: MIT
// Where a body's skin is: distances that were baked at rest, in the pose of a step (docs/engine.md, "Bodies"). As
// engine/body_sample-inl.h and models/rods/rod_body-inl.h, for one place of a thread.
#include "body_types.h"

cbuffer Body : register(b3) { BodyConstants gBody; };
StructuredBuffer<uint> gBodyTable : register(t13);    // arrays of BodyTable, one behind the other
StructuredBuffer<float4> gBodyPoses : register(t11);  // per step: poses of the palette; behind them: bones of each step

#define BODY_NOWHERE 1e30

/// Rows of a map of places: dot(row.xyz, p) + row.w.
struct BodyPose {
    float4 x, y, z;
};
float3 placed(BodyPose pose, float3 p) {
    return float3(dot(pose.x.xyz, p) + pose.x.w, dot(pose.y.xyz, p) + pose.y.w, dot(pose.z.xyz, p) + pose.z.w);
}
BodyPose poseAtRow(uint row) {
    BodyPose pose;
    pose.x = gBodyPoses[row];
    pose.y = gBodyPoses[row + 1];
    pose.z = gBodyPoses[row + 2];
    return pose;
}
/// Of the palette; `step`: 0 for the start of the frame.
BodyPose bodyPose(uint step, uint entry) {
    return poseAtRow((step * gBody.palette + entry) * HAIRLOOM_BODY_POSE_ROWS);
}
uint boneRow(uint step, uint bone) { return gBody.bonesAt + (step * gBody.size.w + bone) * HAIRLOOM_BODY_BONE_ROWS; }
/// What takes places in the world at the end of a step to rest.
BodyPose boneInverse(uint step, uint bone) { return poseAtRow(boneRow(step, bone)); }
/// To the world at the start of the step.
BodyPose boneBefore(uint step, uint bone) { return poseAtRow(boneRow(step, bone) + 3u); }
/// x: metres in the world of one that it carries, at least, 0 where it is flat; y: metres that other skin goes against it in the
/// step, at most; z: 0 where nodes are not looked for in its space.
float4 boneFacts(uint step, uint bone) { return gBodyPoses[boneRow(step, bone) + 6u]; }

/// Of a map that is not flat: rows of what undoes its linear part.
struct BodyUndone {
    float3 x, y, z;
};
BodyUndone undoneOf(BodyPose pose) {
    const float3 a = float3(pose.x.x, pose.y.x, pose.z.x), b = float3(pose.x.y, pose.y.y, pose.z.y),
                 c = float3(pose.x.z, pose.y.z, pose.z.z);
    const float inverse = 1.0 / dot(a, cross(b, c));
    BodyUndone undone;
    undone.x = cross(b, c) * inverse;
    undone.y = cross(c, a) * inverse;
    undone.z = cross(a, b) * inverse;
    return undone;
}
/// As isFlatPose() tells.
bool isRound(BodyPose pose) {
    const float3 a = float3(pose.x.x, pose.y.x, pose.z.x), b = float3(pose.x.y, pose.y.y, pose.z.y),
                 c = float3(pose.x.z, pose.y.z, pose.z.z);
    const float size = sqrt(dot(a, a) * dot(b, b) * dot(c, c));
    return abs(dot(a, cross(b, c))) > 1e-3 * size && size > 1e-9 && size < BODY_NOWHERE;
}

float3 cellsFrom(float3 rest) { return (rest - gBody.low.xyz) * (1.0 / gBody.low.w); }
bool isInTable(float3 cells) {
    const float3 size = float3(gBody.size.xyz);
    return all(cells >= 0.0) && all(cells <= size);
}

/// Corners of a cell along x, then y, then z; w: the value there, xyz: its gradient in steps of the cell.
float4 bodyTrilinear(float v[8], float3 at, float unit) {
    const float x00 = lerp(v[0], v[1], at.x), x10 = lerp(v[2], v[3], at.x), x01 = lerp(v[4], v[5], at.x),
                x11 = lerp(v[6], v[7], at.x);
    const float y0 = lerp(x00, x10, at.y), y1 = lerp(x01, x11, at.y);
    return float4(lerp(lerp(v[1] - v[0], v[3] - v[2], at.y), lerp(v[5] - v[4], v[7] - v[6], at.y), at.z),
                  lerp(x10 - x00, x11 - x01, at.z), y1 - y0, lerp(y0, y1, at.z)) *
           unit;
}

/// The number of a cell along each axis, and the place in it.
uint3 bodyCell(float3 at, float3 last, out float3 within) {
    const uint3 cell = uint3(min(max(at, 0.0), last));
    within = at - float3(cell);
    return cell;
}

/// xyz: gradient at rest; w: metres. BodyField::at().
float4 sampleBody(float3 rest) {
    const float3 at = cellsFrom(rest);
    if (!isInTable(at)) return float4(0, 1, 0, BODY_NOWHERE);
    const float perCell = 1.0 / gBody.low.w, kCells = float(HAIRLOOM_BODY_BLOCK_CELLS);
    float3 within;
    const uint3 cell = bodyCell(at, float3(gBody.size.xyz) - 1.0, within);
    const uint entry = gBodyTable[(cell.z * gBody.size.y + cell.y) * gBody.size.x + cell.x];
    uint block = entry & 0xffffu;
    const bool has = block != HAIRLOOM_BODY_NO_BLOCK;
    float4 fine = float4(0, 0, 0, 0);
    float v[8];
    if (has) {
        float3 inner;
        uint3 place = bodyCell(within * kCells, float3(kCells, kCells, kCells) - 1.0, inner);
        float steps = perCell * kCells;
        if ((entry & 0x1000000u) != 0u) {
            const uint which = gBodyTable[gBody.refinements + block];
            const uint own = gBodyTable[gBody.finer + which * 64u + (place.z * 16u + place.y * 4u + place.x)];
            if (own != HAIRLOOM_BODY_NO_BLOCK) {
                float3 innermost;
                place = bodyCell(inner * kCells, float3(kCells, kCells, kCells) - 1.0, innermost);
                inner = innermost;
                block = own;
                steps *= kCells;
            }
        }
        const uint quad = gBody.quads + block * HAIRLOOM_BODY_BLOCK_QUADS + (place.z * 16u + place.y * 4u + place.x);
        [unroll] for (uint layer = 0; layer < 2; ++layer) {
            const int four = int(gBodyTable[quad + layer * 16u]);
            v[4 * layer] = float((four << 24) >> 24);
            v[4 * layer + 1] = float((four << 16) >> 24);
            v[4 * layer + 2] = float((four << 8) >> 24);
            v[4 * layer + 3] = float(four >> 24);
        }
        fine = bodyTrilinear(v, inner, HAIRLOOM_BODY_FINE_UNIT);
        fine.xyz *= steps;
        if (abs(fine.w) <= HAIRLOOM_BODY_FINE_REACH) return fine;
    }
    const uint row = gBody.size.x + 1u, slice = row * (gBody.size.y + 1u);
    const uint corner = gBody.pairs + (cell.z * (gBody.size.y + 1u) + cell.y) * row + cell.x;
    [unroll] for (uint i = 0; i < 4; ++i) {
        const int pair = int(gBodyTable[corner + (i & 1u) * row + (i >> 1u) * slice]);
        v[2 * i] = float((pair << 16) >> 16);
        v[2 * i + 1] = float(pair >> 16);
    }
    float4 coarse = bodyTrilinear(v, within, gBody.unit);
    coarse.xyz *= perCell;
    if (!has) return coarse;
    const float share = (abs(fine.w) - HAIRLOOM_BODY_FINE_REACH) * (1.0 / (HAIRLOOM_BODY_FINE_END - HAIRLOOM_BODY_FINE_REACH));
    return lerp(fine, coarse, min(max(share, 0.0), 1.0));
}

/// The nearest corner of the table, and how many cells it is away.
uint nearestCorner(float3 cells, out float away) {
    const uint3 corner = uint3(min(max(cells, 0.0) + 0.5, float3(gBody.size.xyz)));
    const float3 off = cells - float3(corner);
    away = sqrt(dot(off, off));
    return (corner.z * (gBody.size.y + 1u) + corner.y) * (gBody.size.x + 1u) + corner.x;
}
/// Metres from a box at least, 0 in it.
float besideBox(float3 low, float3 high, float3 p) {
    const float3 beside = max(low - p, p - high);
    return max(max(beside.x, beside.y), max(beside.z, 0.0));
}
/// BodyField::freeAround().
float freeAtRest(float3 rest) {
    const float3 cells = cellsFrom(rest);
    if (!isInTable(cells)) return besideBox(gBody.low.xyz, gBody.low.xyz + float3(gBody.size.xyz) * gBody.low.w, rest);
    float away;
    const int pair = int(gBodyTable[gBody.pairs + nearestCorner(cells, away)]);
    return max((float((pair << 16) >> 16) - 0.5) * gBody.unit - 1.0001 * gBody.low.w * away, 0.0);
}
/// Metres that a body is away at least from a place at `distance` of it: surelyFree().
float surelyFree(float distance) {
    const float unsure = distance < HAIRLOOM_BODY_FINE_REACH ? HAIRLOOM_BODY_UNSURE_FINE : HAIRLOOM_BODY_UNSURE;
    return HAIRLOOM_BODY_SURE * distance - unsure * gBody.low.w;
}
/// Metres at rest from the box of a bone.
float besideBone(uint bone, float3 rest) {
    if (gBody.hasBoxes == 0u || gBody.size.w == 1u) return 0.0;
    const uint box = gBody.boxes + 6u * bone;
    return besideBox(asfloat(uint3(gBodyTable[box], gBodyTable[box + 1], gBodyTable[box + 2])),
                     asfloat(uint3(gBodyTable[box + 3], gBodyTable[box + 4], gBodyTable[box + 5])), rest);
}
/// Of 255, how much a bone moves what is near a place at rest.
uint shareOfBone(uint bone, float3 rest) {
    const float3 cells = cellsFrom(rest);
    if (!(dot(cells, cells) < 1e12)) return 0u;
    float away;
    const uint skin = gBodyTable[gBody.skins + nearestCorner(cells, away)];
    const uint bones = gBodyTable[gBody.skinBones + skin], weights = gBodyTable[gBody.skinWeights + skin];
    uint share = 0u;
    [unroll] for (uint i = 0; i < 4; ++i)
        share += ((bones >> (8u * i)) & 0xffu) == bone ? (weights >> (8u * i)) & 0xffu : 0u;
    return share;
}

/// What takes places near one of the body at rest to the world: PosedBody::poseAt().
BodyPose poseNear(uint step, float3 rest) {
    if (gBody.palette == 1u) return bodyPose(step, 0u);
    float3 within;
    const uint3 cell = bodyCell(cellsFrom(rest), float3(gBody.size.xyz) - 1.0, within);
    const uint row = gBody.size.x + 1u, slice = row * (gBody.size.y + 1u);
    const uint corner = gBody.skins + cell.z * slice + cell.y * row + cell.x;
    uint skins[8];
    bool same = true;
    [unroll] for (uint k = 0; k < 8; ++k) {
        skins[k] = gBodyTable[corner + (k & 1u) + ((k >> 1u) & 1u) * row + (k >> 2u) * slice];
        same = same && skins[k] == skins[0];
    }
    if (same) return bodyPose(step, skins[0]);
    const float3 rest1 = 1.0 - within;
    BodyPose sum;
    sum.x = sum.y = sum.z = float4(0, 0, 0, 0);
    [loop] for (uint n = 0; n < 8; ++n) {
        const float weight = ((n & 1u) != 0u ? within.x : rest1.x) * ((n & 2u) != 0u ? within.y : rest1.y) *
                             ((n & 4u) != 0u ? within.z : rest1.z);
        const uint entry = gBodyTable[corner + (n & 1u) + ((n >> 1u) & 1u) * row + (n >> 2u) * slice];
        const BodyPose pose = bodyPose(step, entry);
        sum.x += pose.x * weight;
        sum.y += pose.y * weight;
        sum.z += pose.z * weight;
    }
    return sum;
}

/// PosedBody::Contact; nothing is known where the distance is BODY_NOWHERE.
struct BodyContact {
    float distance;  ///< metres in the world
    float3 normal;   ///< out of the body, unit length
    float3 rest;     ///< the place on the body at rest
};

/// Takes a place at rest, which `pose` takes to the world, if it is nearer than what was found.
void takeNearer(float3 rest, BodyPose pose, inout BodyContact nearest) {
    const float4 found = sampleBody(rest);
    if (found.w >= BODY_NOWHERE) return;
    const BodyUndone back = undoneOf(pose);
    const float3 gradient = back.x * found.x + back.y * found.y + back.z * found.z;
    const float slope = sqrt(dot(gradient, gradient));
    // On the ridge between two sides the slope vanishes: there is no way out that is the nearest.
    if (!(slope > 1e-3)) return;
    // Bones that stretch the skin stretch what is before it.
    const float distance = found.w * (sqrt(dot(found.xyz, found.xyz)) / slope);
    if (!(distance < nearest.distance)) return;
    nearest.distance = distance;
    nearest.normal = gradient * (1.0 / slope);
    nearest.rest = rest;
}

/// Where skin takes a place in the world from, by repeated substitution from `rest` on, with Anderson's mixing of two; false
/// where it does not settle.
bool followSkin(uint step, float3 point_ws, inout float3 rest, out BodyPose pose) {
    float3 stepBefore = float3(0, 0, 0), nextBefore = float3(0, 0, 0);
    float off = BODY_NOWHERE;
    pose = bodyPose(step, 0u);
    [loop] for (uint round = 0; round < 12u; ++round) {
        pose = poseNear(step, rest);
        const BodyUndone back = undoneOf(pose);
        const float3 from = point_ws - float3(pose.x.w, pose.y.w, pose.z.w);
        const float3 next = float3(dot(back.x, from), dot(back.y, from), dot(back.z, from));
        const float3 way = next - rest, turned = way - stepBefore;
        off = sqrt(dot(way, way));
        rest = next;
        if (!(off > 1e-5)) break;
        const float share = dot(way, turned) / dot(turned, turned);
        if (round > 0u && abs(share) <= 2.0) rest = next - (next - nextBefore) * share;
        stepBefore = way;
        nextBefore = next;
    }
    return off < 2e-3 && isRound(pose);
}

/// PosedBody::at(). `step`: 0 for the start of the frame, its poses are those of the end of the step before.
BodyContact bodyContact(uint step, float3 point_ws) {
    BodyContact nearest;
    nearest.distance = BODY_NOWHERE;
    nearest.normal = float3(0, 1, 0);
    nearest.rest = float3(0, 0, 0);
    const bool isWhole = gBody.size.w == 1u;
    const uint bones = gBody.size.w;
    float least = BODY_NOWHERE;
    [loop] for (uint i = 0; i < bones; ++i) {
        const float own = boneFacts(step, i).x;
        if (own > 0.0) least = min(least, own);
    }
    float3 found[4] = {float3(0, 0, 0), float3(0, 0, 0), float3(0, 0, 0), float3(0, 0, 0)};
    uint places = 0u;
    // What a bone moves much of is found from where the bone has it; what another bone has been found to share, or to be beside,
    // is the same place. Where no bone has anything, all are tried.
    [loop] for (uint turn = 0; turn < 2u * bones; ++turn) {
        const bool triesAll = turn >= bones;
        if (triesAll && (places > 0u || isWhole)) break;
        const uint b = triesAll ? turn - bones : turn;
        if (!(boneFacts(step, b).x > 0.0)) continue;
        float3 rest = placed(boneInverse(step, b), point_ws);
        BodyPose pose = bodyPose(step, 0u);
        if (!isWhole) {
            if (besideBone(b, rest) > 0.0) continue;
            // Its own place, then those that were found.
            bool known = false, own = triesAll;
            [loop] for (uint k = 0; k <= places && !triesAll; ++k) {
                const float3 place = k == 0u ? rest : found[k - 1u];
                const uint share = shareOfBone(b, place);
                const float3 off = rest - place;
                if (k == 0u) {
                    own = share > 0u;
                } else {
                    known = known || share >= 64u || (share > 0u && dot(off, off) < gBody.low.w * gBody.low.w);
                }
            }
            if (known || !own) continue;
            // What one bone has shown is nearer than anything that another carries.
            if (freeAtRest(rest) * (0.5 * least) > nearest.distance) continue;
            if (!followSkin(step, point_ws, rest, pose)) continue;
            if (places < 4u) found[places++] = rest;
        }
        takeNearer(rest, pose, nearest);
    }
    return nearest;
}

/// What is free around a place at the end of a step.
struct BodyRoom {
    float free;     ///< metres that skin is away at least
    float against;  ///< metres that a node which has moved by `moved` has gone against the nearest skin, and other skin against that
};
BodyRoom roomAround(uint step, float3 point_ws, float3 moved) {
    BodyRoom room;
    room.free = BODY_NOWHERE;
    const float gone = sqrt(dot(moved, moved));
    room.against = 2.0 * gone;
    float nearest = BODY_NOWHERE;
    // A body that moves as a whole is as far as it is at rest; skin between two bones may be closer, but hardly by half.
    const float sure = gBody.size.w == 1u ? 1.0 : 0.5;
    [loop] for (uint b = 0; b < gBody.size.w; ++b) {
        const float4 facts = boneFacts(step, b);
        if (!(facts.x > 0.0)) continue;
        const float3 rest = placed(boneInverse(step, b), point_ws);
        const float beside = besideBone(b, rest);
        if (beside * facts.x >= max(room.free, nearest)) continue;
        const float free = freeAtRest(rest);
        room.free = min(room.free, max(beside, sure * free) * facts.x);
        const float away = max(beside, free) * facts.x;
        if (facts.z == 0.0 || away >= nearest) continue;
        nearest = away;
        const float3 slid = moved - (point_ws - placed(boneBefore(step, b), rest));
        room.against = sqrt(dot(slid, slid)) + facts.y;
    }
    return room;
}
