// SPDX-License-Identifier: GPL-3.0-or-later
// For strand_blend.frag, which has no use for chance.
#define HAIRLOOM_BLEND
#include "shaders/render/strand.vert.hlsl"
