// SPDX-License-Identifier: MIT
// Length of segments: the constraint, and the maximal extension as post-processing.

#define PROJECT_POSITIONS 0      // segments get their length back; the move counts as velocity
#define PROJECT_POSITIONS_WITH_CURRENT_GRADIENT 1  // likewise, with tension along the segments as they are after the integration
#define PROJECT_DISPLACEMENTS 2       // the velocity's part that would change lengths is taken out

float3 startOfSubstep(uint p) {
#if HAIR_EVALUATION >= 1
    return start(p);
#else
    return previous(p);
#endif
}

/// Where the tension of a segment acts: along the gradient at the start of the substep (SHAKE, Ryckaert et al.
/// 1977); segments that turn by more than 60° in a substep take that of now.
float3 actingGradient(int holding, float3 wanted, uint s, float inverse) {
    if (holding != PROJECT_POSITIONS) return wanted;
    const float3 before = (startOfSubstep(s + 1) - startOfSubstep(s)) * inverse;
    return dot(wanted, before) > 0.5 * dot(wanted, wanted) ? before : wanted;
}

#if HAIR_TENSIONS
/// Keeps tension for the bending of the next substep. Slowly: what bending makes of it comes back a substep late. And
/// no more than Verlet holds across a segment, by half of its limit. `weights` of the segment's ends together.
void keepTension(uint s, float added, float size, float weights) {
    const float maximum = 0.5 * size / weights;
    setTension(s, clamp(tension(s) + added * gFrame.substep.tensionShare, -maximum, maximum));
}
#endif

/// Whether a segment is shorter than (1 − ε) or longer than (1 + ε) of its length.
bool isWrong(float3 edge, float rest) {
    const float low = rest * (1.0 - gFrame.substep.maximalExtension), high = rest * (1.0 + gFrame.substep.maximalExtension);
    const float squared = dot(edge, edge);
    return squared > high * high || squared < low * low;
}

/// Where the outer end of a segment from `parent` to `here` is between both (Provot 1995, both ways). Not `here` and
/// a move: of a point that was far away only rounding would be left.
float3 withinExtension(float3 parent, float3 here, float rest) {
    const float3 edge = here - parent;
    if (!isWrong(edge, rest)) return here;
    const float size = sqrt(dot(edge, edge));
    const float bounded =
        min(max(size, rest * (1.0 - gFrame.substep.maximalExtension)), rest * (1.0 + gFrame.substep.maximalExtension));
    const bool flat = size < 1e-12;
    return parent + (flat ? float3(0, -bounded, 0) : edge * (bounded / (flat ? 1.0 : size)));
}

/// The move counts as velocity only where that slows the point relative to its root: it never adds energy.
void moveTo(uint p, float3 to) {
    const float3 here = position(p), before = previous(p);
    const float3 move = to - here, moving = here - before - gRootDisplacement;
    const float braking = -dot(moving, move) / (dot(move, move) + 1e-30);
    setPosition(p, to);
    setPrevious(p, before + move * (1.0 - min(max(braking, 0.0), 1.0)));
}

#if HAIR_STORAGE == 3
#include "lanes_length.hlsli"
#else
/// One Newton step on all length constraints ½(|e|²/l − l) = 0 of a strand together, or on their rates
/// e·ė/l = 0; clamped points have infinite mass. The system is tridiagonal and is solved directly (after
/// Goldenthal et al. 2007; with displacements, RATTLE, Andersen 1983). Collapsed segments keep a diagonal of at least
/// ¼ of their masses': no overshoot.
void projectStrand(int holding) {
    float inverse = 0.0, lastRight = 0.0;
    float3 lastWanted = float3(0, 0, 0), lastActing = float3(0, 0, 0);
    EACH for (uint s = FIRST_FREE - 1; s + 1 < POINTS; ++s) {
        const float size = segmentLength(s);
        const float3 edge = position(s + 1) - position(s);
        const float inverseSize = inverseOf(size);
        const float3 wanted = edge * inverseSize;
        const float3 acting = actingGradient(holding, wanted, s, inverseSize);
        float error;
        if (holding == PROJECT_DISPLACEMENTS) {
            error = dot(wanted, edge - (previous(s + 1) - previous(s)));
        } else {
            error = 0.5 * (dot(edge, wanted) - size);
        }
        const float own = max(dot(wanted, acting), 0.25);
        const float outer = inverseMass(s + 1);
        float up = 0.0;
        if (s == FIRST_FREE - 1) {
            inverse = 1.0 / (own * outer);
            error *= inverse;
        } else {
            const float inner = inverseMass(s);
            const float below = dot(wanted, lastActing) * inner;
            up = dot(lastWanted, acting) * inner * inverse;
            inverse = 1.0 / (own * (inner + outer) - below * up);
            error = (error + below * lastRight) * inverse;
        }
        setUpper(s, up);
        setRight(s, error);
        setWork(s, acting);
        lastRight = error;
        lastWanted = wanted;
        lastActing = acting;
    }
    float lambda = 0.0, upAfter = 0.0;
    float3 after = float3(0, 0, 0);
    EACH for (int t = int(POINTS) - 2; t >= FIRST_FREE - 1; --t) {
        lambda = right(t) + upAfter * lambda;
        upAfter = upper(t);
        const float3 pull = work(t) * lambda;
        const float3 move = (after - pull) * inverseMass(t + 1);
        if (holding == PROJECT_DISPLACEMENTS) {
            setPrevious(t + 1, previous(t + 1) - move);
        } else {
            setPosition(t + 1, position(t + 1) + move);
        }
#if HAIR_TENSIONS
        if (holding == PROJECT_POSITIONS) keepTension(t, lambda, segmentLength(t), inverseMass(t) + inverseMass(t + 1));
#endif
        after = pull;
    }
}

/// Maximal extension, root to tip.
void stageExtension() {
    float3 parent = position(FIRST_FREE - 1);
    EACH for (uint p = FIRST_FREE; p < POINTS; ++p) {
        const float rest = segmentLength(p - 1);
        const float3 here = position(p);
        const float3 to = withinExtension(parent, here, rest);
        if (isWrong(here - parent, rest)) moveTo(p, to);
        parent = to;
    }
}
#endif

void stageLength() {
    [loop] for (uint n = 0; n < gFrame.lengthIterations; ++n) projectStrand(PROJECT_POSITIONS);
}
void stageLengthNow() {
    [loop] for (uint n = 0; n < gFrame.lengthIterations; ++n) projectStrand(PROJECT_POSITIONS_WITH_CURRENT_GRADIENT);
}
void stageLengthRate() { projectStrand(PROJECT_DISPLACEMENTS); }
