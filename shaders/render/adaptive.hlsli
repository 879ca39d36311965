// SPDX-License-Identifier: GPL-3.0-or-later
// Adaptive volumetric shadow maps (Salvi, Vidimče, Lauritzen and Lefohn 2010): the transmittance behind a texel as a line through a
// few nodes. Before the first the light is whole, behind the last it stays. A node is a word: 16 bits of depth as a part of the
// light's range, then 16 of the fibres before it, so that what shading asks for comes from it exactly.
#ifndef HAIRLOOM_ADAPTIVE_HLSLI
#define HAIRLOOM_ADAPTIVE_HLSLI
#include "shaders/render/opacity.hlsli"

// Light that n fibres leave, exp(-n / 2): what the line is straight in.
float lightBehind(float fibres) { return exp(-0.5 * fibres); }

// `part` of the light's range.
uint packNode(float part, float fibres) {
    const uint depth = uint(saturate(part) * 65535.0 + 0.5);
    return (depth << 16u) | uint(saturate(fibres * OPACITY_UNIT) * 65535.0 + 0.5);
}

// As a part of the light's range, and the fibres before it.
float2 unpackNode(uint node) {
    return float2(float(node >> 16u) * (1.0 / 65535.0), float(node & 0xffffu) * (1.0 / (65535.0 * OPACITY_UNIT)));
}

// A number of chance from two.
uint chanceOf(uint a, uint b) {
    uint h = a * 747796405u + b * 2891336453u + 277803737u;
    h = ((h >> ((h >> 28u) + 4u)) ^ h) * 277803737u;
    return (h >> 22u) ^ h;
}

// The share of a texel's pieces that its list takes, likewise by chance.
float listedShareOfTexel(uint found) { return found <= HAIRLOOM_LISTED_OF_TEXEL ? 1.0 : 0.94 * float(HAIRLOOM_LISTED_OF_TEXEL) / float(found); }

// The share of all pieces of hair that lists for `most` take: 1 where all fit, else somewhat fewer than fit, for each is taken by chance.
float listedShare(uint all, uint most) { return all <= most ? 1.0 : 0.98 * float(most) / float(all); }
#endif
