// SPDX-License-Identifier: MIT
// What a thread does with its strand before and after the substeps of a frame.

void loadState() {
#if HAIR_STORAGE != 2
    EACH for (uint p = 0; p < POINTS; ++p) {
        setPosition(p, savedPosition(p));
        setPrevious(p, savedPrevious(p));
#if HAIR_TENSIONS
        setTension(p, savedTension(p));
#endif
    }
#endif
}

void saveState() {
#if HAIR_STORAGE != 2
    EACH for (uint p = 0; p < POINTS; ++p) {
        savePosition(p, position(p));
        savePrevious(p, previous(p));
#if HAIR_TENSIONS
        saveTension(p, tension(p));
#endif
    }
#endif
}

/// Puts the strand to its rest position on the root of the end of the frame, without speed.
void placeAtRest() {
    float3 at = float3(0, 0, 0);
    EACH for (uint p = 0; p < POINTS; ++p) {
        setPosition(p, at);
        setPrevious(p, at);
        at += rotate(gRootsTo[2 * gSlot + 1], restVector(p));
#if HAIR_TENSIONS
        setTension(p, 0.0);
#endif
    }
#if HAIR_RODS
    placeRodAtRest();
#endif
}

/// Greatest squared displacement of a free point in the last substep; `sound` is false where a point is no
/// number or has left the range in which its square is one.
float fastest(out bool sound) {
    float maximum = 0.0;
    sound = true;
    EACH for (uint p = 0; p < POINTS; ++p) {
        const float3 here = position(p);
        const float3 moved = here - previous(p);
        const float squared = dot(moved, moved);
        sound = sound && isSound(here) && isSound(moved) && dot(here, here) < 1e12 && squared < 1e12;
        if (p >= FIRST_FREE) maximum = max(maximum, squared);
    }
    return maximum;
}

void writePosition(uint p) {
    const uint first = gFirstPoints[gSlot];
    if (first == 0xffffffffu) return;
    gPositions_ws[first + p] = float4(gRootsTo[2 * gSlot].xyz + position(p), 1.0);
#if HAIR_VELOCITIES
    gVelocities[first + p] = float4((position(p) - previous(p)) * (1.0 / gFrame.h), 0.0);
#endif
}

/// Takes stock after the last substep; the group's greatest displacement in gGroupFastest.
void finishStrand(uint block, uint lane) {
    bool sound;
    float maximum = fastest(sound);
    if (!sound) {
        placeAtRest();
        maximum = 0.0;
        if (lane < gBlocks[block].y) InterlockedAdd(gReport[REPORT_RESTORED], 1u);
        InterlockedOr(gGroupRestored, 1u);
    }
    InterlockedMax(gGroupFastest, asuint(maximum));
#if HAIR_SLEEP
    if (gFrame.wakeAll == 0u) {
        [unroll] for (uint a = 0; a < HAIRLOOM_REST_ANCHORS; ++a) lookAtAnchor(a, position(anchorPoint(a, POINTS)));
    }
#endif
}
