// SPDX-License-Identifier: GPL-3.0-or-later
// Colour or absorption from place to place, by the look that is bound.
#ifndef HAIRLOOM_LOOK_HLSLI
#define HAIRLOOM_LOOK_HLSLI
#include "runtime/shaders/hair_look.hlsli"
#include "shaders/render/curve.hlsli"

cbuffer Look : register(b2) { LookConstants gLook; };

float3 lookAt(StrandPlace p) { return lookOf(gLook, p); }
float3 emissionAt(float along) { return emissionOf(gLook, along); }
#endif
