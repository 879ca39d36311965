// SPDX-License-Identifier: GPL-3.0-or-later
#define HAIRLOOM_LOOK
#include "shaders/render/hair_albedo.comp.hlsl"
