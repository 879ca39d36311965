// SPDX-License-Identifier: MIT
#include "follow_types.h"
#include "math.hlsli"

cbuffer Follow : register(b0) { FollowConstants gFollow; };

// Of each guide four rows of `points`: positions, and of its wisp the centres and both axes.
#define FOLLOW_ROWS 4
uint rowOf(uint guide, uint row, uint p) { return (guide * FOLLOW_ROWS + row) * gFollow.points + p; }
