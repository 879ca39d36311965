// SPDX-License-Identifier: MIT
// Coil and flexion springs, and maximal extension by velocities.

/// The impulse along a segment that would leave its bounds; `weights` of its ends together.
float3 limitImpulse(float3 edgeVector, float rest, float weights) {
    const Direction edge = edgeOf(edgeVector);
    const float wrong = edge.size - min(max(edge.size, rest * (1.0 - gFrame.substep.maximalExtension)),
                                        rest * (1.0 + gFrame.substep.maximalExtension));
    return edge.unit * (wrong / weights);
}

#if HAIR_STORAGE == 3
#include "lanes_springs.hlsli"
#else
/// Coil springs (Rünz 2012, Eq. 3; the whole force on each end), k h² the harmonic mean of the masses of the
/// ends times (ω h)².
void stageSprings() {
    float3 inner = float3(0, 0, 0);
    EACH for (uint p = FIRST_FREE - 1; p < POINTS; ++p) {
        const float mass = inverseMass(p);
        float3 outer = float3(0, 0, 0);
        if (p + 1 < POINTS) {
            const Direction edge = edgeOf(position(p + 1) - position(p));
            const float step = 2.0 * gFrame.substep.springStep / (mass + inverseMass(p + 1));
            outer = edge.unit * ((edge.size - segmentLength(p)) * step);
        }
        if (p >= FIRST_FREE) setPrevious(p, previous(p) - (outer - inner) * mass);
        inner = outer;
    }
}

#if HAIR_BEND
/// Flexion springs between every second point (Selle et al. 2008 call them bending springs).
void stageFlexion() {
    EACH for (uint p = 1; p + 1 < POINTS; ++p) {
        const float3 span = restVector(p - 1) + restVector(p);
        const Direction edge = edgeOf(position(p + 1) - position(p - 1));
        const float3 pull = edge.unit * ((edge.size - sqrt(dot(span, span))) * stiffness(p));
        if (p + 1 >= FIRST_FREE) setPrevious(p + 1, previous(p + 1) + pull * inverseMass(p + 1));
        if (p - 1 >= FIRST_FREE) setPrevious(p - 1, previous(p - 1) - pull * inverseMass(p - 1));
    }
}
#endif

/// Maximal extension by velocities (Bridson et al. 2003): impulses along segments that would leave their
/// bounds, root to tip, momentum kept.
void stageSpringLimit() {
    [loop] for (uint n = 0; n < gFrame.lengthIterations; ++n) {
        EACH for (uint p = FIRST_FREE; p < POINTS; ++p) {
            const float3 from = position(p - 1), to = position(p);
            const float outer = inverseMass(p);
            const float inner = p > FIRST_FREE ? inverseMass(p - 1) : 0.0;
            const float3 impulse = limitImpulse(to - from, segmentLength(p - 1), outer + inner);
            setPosition(p, to - impulse * outer);
            if (p > FIRST_FREE) setPosition(p - 1, from + impulse * inner);
        }
    }
}
#endif
