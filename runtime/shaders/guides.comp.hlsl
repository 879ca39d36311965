// SPDX-License-Identifier: MIT
// A frame of guides as rods in wind, among spheres that stand in a buffer; for games (hairloom/gpu.h, pass GUIDES).
#define HAIR_RODS 1
#define HAIR_MEMBERS 1
#define HAIR_STRANDS 32
#define HAIR_TOGETHER 0
#define HAIR_CLAMPED 2
#define HAIR_SPHERES 2
#define HAIR_WIND 1
#define HAIR_SLEEP 1
#define HAIR_VELOCITIES 1
#define HAIR_STAGES stageRoots(); stageRod();
#include "rods.hlsli"
