// SPDX-License-Identifier: GPL-3.0-or-later
// A texel's list of hair, sorted and compressed to the nodes that shading reads. Each piece of hair adds a step down, of two nodes;
// once there are too many, the one goes whose triangle with its neighbours is smallest, and so changes the line's integral least
// (Salvi et al. 2010). The others stay where they are, or nodes would drift. Pieces of one depth are sorted by how much they are:
// what is then left to chance are equal pieces, whichever strands they are of.
#include "shaders/render/adaptive.hlsli"

// Kept until the list ends. The paper keeps no more than a texel has, for it sees a piece of hair once, and comes less near to the
// best choice of nodes.
#define NODES_AT_WORK 24u

cbuffer Constants : register(b0) { PackConstants gPack; };
StructuredBuffer<uint> gBegins : register(t0);
RWStructuredBuffer<uint> gFragments : register(u0);
RWStructuredBuffer<uint> gOpacity : register(u1);  // gPack.words a texel

uint following(uint place) { return gFragments[HAIRLOOM_LISTED_WORDS * (place - 1u) + 2u]; }

void link(uint place, uint next) { gFragments[HAIRLOOM_LISTED_WORDS * (place - 1u) + 2u] = next; }

bool comesFirst(uint a, uint b) {
    const uint depthA = gFragments[HAIRLOOM_LISTED_WORDS * (a - 1u)];
    const uint depthB = gFragments[HAIRLOOM_LISTED_WORDS * (b - 1u)];
    if (depthA != depthB) return depthA < depthB;
    return gFragments[HAIRLOOM_LISTED_WORDS * (a - 1u) + 1u] <= gFragments[HAIRLOOM_LISTED_WORDS * (b - 1u) + 1u];
}

// Merges runs of twice the length in each round, in place.
uint sorted(uint list) {
    uint merges = 2u;
    for (uint run = 1u; merges > 1u; run *= 2u) {
        uint a = list;
        uint last = 0u;
        list = 0u;
        merges = 0u;
        while (a != 0u) {
            merges += 1u;
            uint b = a;
            uint ofA = 0u;
            while (ofA < run && b != 0u) {
                b = following(b);
                ofA += 1u;
            }
            uint ofB = run;
            while (ofA > 0u || (ofB > 0u && b != 0u)) {
                bool takesA = ofA > 0u;
                if (takesA && ofB > 0u && b != 0u) takesA = comesFirst(a, b);
                const uint taken = takesA ? a : b;
                if (takesA) {
                    a = following(a);
                    ofA -= 1u;
                } else {
                    b = following(b);
                    ofB -= 1u;
                }
                if (last != 0u) link(last, taken);
                if (last == 0u) list = taken;
                last = taken;
            }
            a = b;
        }
        if (last != 0u) link(last, 0u);
    }
    return list;
}

[numthreads(HAIRLOOM_TILE_GROUP, HAIRLOOM_TILE_GROUP, 1)]
void main(uint3 id : SV_DispatchThreadID) {
    if (id.x >= gPack.side || id.y >= gPack.side) return;
    float depths[NODES_AT_WORK + 2u];
    float counts[NODES_AT_WORK + 2u];
    float lights[NODES_AT_WORK + 2u];
    uint nodes = 0u;
    uint sum = 0u;
    uint place = sorted(gBegins[id.y * gPack.side + id.x]);
    while (place != 0u) {
        const float z = asfloat(gFragments[HAIRLOOM_LISTED_WORDS * (place - 1u)]);
        const float depth = metresBehindNear(gPack.depthRange, gPack.nearPlane, z);
        const float before = float(sum) * (1.0 / FIBRE_COUNT);
        sum += gFragments[HAIRLOOM_LISTED_WORDS * (place - 1u) + 1u];
        place = following(place);
        const float fibres = float(sum) * (1.0 / FIBRE_COUNT);
        depths[nodes] = depth;
        counts[nodes] = before;
        lights[nodes] = lightBehind(before);
        depths[nodes + 1u] = depth;
        counts[nodes + 1u] = fibres;
        lights[nodes + 1u] = lightBehind(fibres);
        nodes += 2u;
        const uint most = place != 0u ? NODES_AT_WORK : gPack.layers;
        while (nodes > most) {
            // Unrolled: turns of loops are counted (see HAIRLOOM_LISTED_OF_TEXEL).
            uint least = 1u;
            float leastArea = 3e38;
            [unroll] for (uint i = 1u; i <= NODES_AT_WORK; ++i) {
                const float area = abs((depths[i + 1u] - depths[i - 1u]) * (lights[i] - lights[i - 1u]) -
                                       (depths[i] - depths[i - 1u]) * (lights[i + 1u] - lights[i - 1u]));
                if (i + 1u < nodes && area < leastArea) {
                    leastArea = area;
                    least = i;
                }
            }
            nodes -= 1u;
            [unroll] for (uint k = 1u; k <= NODES_AT_WORK; ++k) {
                if (k >= least) {
                    depths[k] = depths[k + 1u];
                    counts[k] = counts[k + 1u];
                    lights[k] = lights[k + 1u];
                }
            }
        }
    }
    const uint word = gPack.words * (id.y * gPack.atlasWidth + gPack.tileLeft + id.x);
    const float all = float(sum) * (1.0 / FIBRE_COUNT);
    for (uint n = 0u; n < gPack.layers; ++n) {
        uint packed = packNode(1.0, all);
        if (n < nodes) packed = packNode(depths[n] / gPack.depthRange, counts[n]);
        gOpacity[word + n] = packed;
    }
}
