// SPDX-License-Identifier: MIT
// Angular springs (docs/engine.md): as forces, and solved together along each strand.
#if HAIR_BEND

float3 unitOf(float3 edge) {
    const float squared = dot(edge, edge);
    return squared < 1e-20 ? float3(0, 0, 0) : edge * (1.0 / sqrt(squared < 1e-20 ? 1.0 : squared));
}

/// The frame of a segment, carried root to tip, turned by the shortest arc (Melax 2000) that takes one
/// direction to the other (Eq. 4): a normal u goes to u − (b·u)/(1 + a·b) · (a + b), bounded at 180°.
float3 carryNormal(float3 normal, float3 from, float3 to) {
    const float flat = max(1.0 + dot(from, to), 1e-6);
    return normal - (from + to) * (dot(to, normal) / flat);
}

/// A vector given in a segment's frame.
float3 fromFrame(float3 tangent, float3 normal, float3 local) {
    return tangent * local.x + normal * local.y + cross(tangent, normal) * local.z;
}


#if HAIR_STORAGE == 3
#include "lanes_bend.hlsli"
#else
/// Pulls of angular springs at `position`.
void measurePulls(bool frames, bool exact) {
    float3 inner = rootTangent(), unit = inner, normal = float3(0, 0, 0);
#if HAIR_TARGETS
    if (frames) normal = rootNormal();
#endif
    EACH for (uint j = 0; j + 1 < POINTS; ++j) {
        const float3 edge = position(j + 1) - position(j);
        const float3 tangent = exact ? unitOf(edge) : edge * inverseLength(j);
        if (j + 1 >= FIRST_FREE) {
            float3 off = tangent - inner;
#if HAIR_TARGETS
            if (frames) off -= fromFrame(unit, normal, target(j));
#endif
            setWork(j, off * stiffness(j));
        }
        if (frames) {
            // Springs may stretch: a frame needs directions of unit length.
            const float3 next = unitOf(edge);
            normal = carryNormal(normal, unit, next);
            unit = next;
        }
        inner = tangent;
    }
    setWork(POINTS - 1, float3(0, 0, 0));
}

/// The gradient of the energy by segment s, times h²: (s_s − s_{s+1})/l, or the part of it across the segment
/// by its true length.
float3 segmentPull(uint s, bool exact) {
    const float3 difference = work(s) - work(s + 1);
    if (!exact) return difference * inverseLength(s);
    const float3 edge = position(s + 1) - position(s);
    const float3 tangent = unitOf(edge);
    const float size = max(dot(edge, tangent), segmentLength(s) * 0.1);
    return (difference - tangent * dot(difference, tangent)) * (1.0 / max(size, 1e-9));
}

/// Angular springs as forces.
void applyAngular(bool frames, bool exact) {
    measurePulls(frames, exact);
    float3 inner = segmentPull(FIRST_FREE - 1, exact);
    EACH for (uint p = FIRST_FREE; p < POINTS; ++p) {
        float3 outer = float3(0, 0, 0);
        if (p + 1 < POINTS) outer = segmentPull(p, exact);
        setPrevious(p, previous(p) + (inner - outer) * inverseMass(p));
        inner = outer;
    }
}
#if HAIR_TARGETS
void stageAngularSmallAngle() { applyAngular(true, false); }
void stageAngularExact() { applyAngular(true, true); }
#endif
void stageStraightSmallAngle() { applyAngular(false, false); }
void stageStraightExact() { applyAngular(false, true); }

#if HAIR_BEND == 2

/// Pulls of angular springs q of the way from `previous` to `position` farther on than `previous`, against the curves of the
/// frames there.
void measureAhead(bool frames) {
    float3 inner = rootTangent(), behind = inner, normal = float3(0, 0, 0);
#if HAIR_TARGETS
    if (frames) normal = rootNormal();
#endif
    EACH for (uint j = 0; j + 1 < POINTS; ++j) {
        const float3 from = previous(j), to = previous(j + 1);
        const float3 moved = (position(j + 1) - to) - (position(j) - from);
        const float3 tangent = ((to - from) + moved * gFrame.substep.bendRate) * inverseLength(j);
        if (j + 1 >= FIRST_FREE) {
            float3 off = tangent - inner;
#if HAIR_TARGETS
            if (frames) off -= fromFrame(behind, normal, target(j));
#endif
            setWork(j, off * stiffness(j));
        }
        if (frames) {
            const float3 next = (to - from) * inverseLength(j);
            normal = carryNormal(normal, behind, next);
            behind = next;
        }
        inner = tangent;
    }
    setWork(POINTS - 1, float3(0, 0, 0));
}

/// And the tension of the last substep, along the segment at the start of this one.
float3 segmentForce(uint s) {
    float3 force = segmentPull(s, false);
#if HAIR_TENSIONS
    force += (previous(s + 1) - previous(s)) * (inverseLength(s) * tension(s));
#endif
    return force;
}

/// Adds to the free points what the pulls of the joints do through (M + share·h² K)⁻¹, by the LDLᵀ factors of the strand,
/// stable for any stiffness (docs/engine.md). The slot of joint p − 1 is free once point p has its right side, and keeps
/// it, then its move.
void solveBend() {
    float3 inner = segmentForce(FIRST_FREE - 1);
    float3 one = float3(0, 0, 0), two = float3(0, 0, 0);  // right sides of the last two points
    EACH for (uint p = FIRST_FREE; p < POINTS; ++p) {
        float3 outer = float3(0, 0, 0);
        if (p + 1 < POINTS) outer = segmentForce(p);
        const float4 factors = gFactors[slotOf(0, p)];
        const float3 side = outer - inner - one * factors.y - two * factors.z;
        setWork(p - 1, side);
        two = one;
        one = side;
        inner = outer;
    }
    // Moves of the next two points, each by the factor that couples it to the one before, or two before.
    float3 next = float3(0, 0, 0), second = float3(0, 0, 0);
    float lower1 = 0.0, lower2 = 0.0, lower2Next = 0.0;
    EACH for (int q = int(POINTS) - 1; q >= FIRST_FREE; --q) {
        const float4 factors = gFactors[slotOf(0, q)];
        const float3 move = work(q - 1) * factors.x - next * lower1 - second * lower2Next;
        setPosition(q, position(q) + move);
        second = next;
        next = move;
        lower1 = factors.y;
        lower2Next = lower2;
        lower2 = factors.z;
    }
}

/// Angular springs after position Verlet, with ¼ + q for the share.
void bendBack(bool frames) {
    measureAhead(frames);
    solveBend();
}
#if HAIR_TARGETS
void stageAngular() { bendBack(true); }
#endif
void stageAngularStraight() { bendBack(false); }
#endif
#endif
#endif
