// SPDX-License-Identifier: MIT
// Curved hair in wind, 16 points each, and the engine's default settings.
#define HAIR_POINTS 16
#define HAIR_EXACT 1
#define HAIR_UNROLL 1
#define HAIR_STORAGE 0
#define HAIR_STRANDS 32
#define HAIR_TOGETHER 0
#define HAIR_TABLES 0
#define HAIR_CLAMPED 2
#define HAIR_EVALUATION 0
#define HAIR_BEND 2
#define HAIR_TARGETS 1
#define HAIR_CURVES 1
#define HAIR_TENSIONS 1
#define HAIR_COUPLED 0
#define HAIR_SPHERES 0
#define HAIR_WIND 1
#define HAIR_SLEEP 1
#define HAIR_VELOCITIES 0
#define HAIR_STAGES stageRoots(); stageDamping(); stageWind(); stageGravity(); stageVerlet(); stageAngular(); stageLength(); stageExtension();
#include "shaders/simulation/strands.hlsli"
