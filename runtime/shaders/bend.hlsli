// SPDX-License-Identifier: MIT
// Angular springs (docs/engine.md): as forces, and solved together along each strand.
#if HAIR_BEND

// Seconds in which curves that lag arrive, and the speed in m/s above which they wait.
#define LEAK_TIME 2.0
#define LEAK_SPEED 0.0015
// Cosine of the turn, 162°, behind which a frame's normal follows from rounding: joints there keep their curves.
#define FOLD -0.95

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

#if HAIR_CURVES
static float gEnergyTank, gMotion;

/// The share of a change of curves that the strand's tank pays, and what that does to the tank. `gain` and `size` are
/// Σ pull · change and Σ stiffness · change² over the joints.
float takeShare(float gain, float size) {
    const bool fresh = gEnergyTank < 0.0;
    const float squared = gFrame.h * gFrame.h;
    const float saved = max(gEnergyTank, 0.0) * squared;
    // Turning by the share α changes the energy by ½ α² s − α d.
    const float maximum = (gain + sqrt(gain * gain + (size + size) * saved)) / max(size, 1e-30);
    const float leak = min(gFrame.h / LEAK_TIME, 1.0) * max(1.0 - gMotion / (LEAK_SPEED * LEAK_SPEED), 0.0);
    const float share = fresh ? 1.0 : max(min(maximum, 1.0), leak);
    const float gained = share * (gain - 0.5 * share * size) / squared;
    gEnergyTank = fresh ? 0.0 : max(max(gEnergyTank, 0.0) + gained, 0.0) * gFrame.substep.velocityShare;
    return share;
}
#endif

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
#if HAIR_CURVES
/// Turns the curves that the joints hold towards those of the frames at `previous`, as far as the strand's tank
/// lasts, which holds what earlier turning took out of the springs (energy tanks, Duindam and Stramigioli 2004).
/// While the strand rests, curves that lag creep home. `work` keeps each joint's whole change; returns the share
/// of it that is taken.
float followFrames() {
    float gain = 0.0, size = 0.0;
    float3 before = rootTangent(), normal = rootNormal();
    float known = 1.0;
    EACH for (uint j = 0; j + 1 < POINTS; ++j) {
        const float3 tangent = (previous(j + 1) - previous(j)) * inverseLength(j);
        if (j + 1 >= FIRST_FREE) {
            const float3 held = rotate(turnNow(), curve(j));
            const float3 change = (fromFrame(before, normal, target(j)) - held) * known;
            const float stiff = stiffness(j);
            gain += dot((tangent - before - held) * stiff, change);
            size += dot(change, change) * stiff;
            setCurve(j, held);
            setWork(j, change);
        }
        normal = carryNormal(normal, before, tangent);
        if (dot(before, tangent) < FOLD) known = 0.0;
        before = tangent;
    }
    return takeShare(gain, size);
}
#endif

/// Pulls of angular springs q of the way from `previous` to `position` farther on than `position`'s start.
void measureAhead(float share) {
    float3 inner = rootTangent();
    EACH for (uint j = 0; j + 1 < POINTS; ++j) {
        const float3 from = previous(j), to = previous(j + 1);
        const float3 moved = (position(j + 1) - to) - (position(j) - from);
        const float3 tangent = ((to - from) + moved * gFrame.substep.bendRate) * inverseLength(j);
        if (j + 1 >= FIRST_FREE) {
            float3 off = tangent - inner;
#if HAIR_CURVES
            const float3 held = curve(j) + work(j) * share;
            setCurve(j, held);
            off -= held;
#endif
            setWork(j, off * stiffness(j));
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

/// Angular springs after position Verlet: the step of their force through (M + (¼ + q) h² K)⁻¹ by the LDLᵀ
/// factors of the strand, stable for any stiffness (docs/engine.md). The slot of joint p − 1 is free once
/// point p has its right side, and keeps it, then its move.
void bendBack() {
    float share = 0.0;
#if HAIR_CURVES
    share = followFrames();
#endif
    measureAhead(share);
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
void stageAngular() { bendBack(); }
void stageAngularStraight() { bendBack(); }
#endif
#endif
#endif
