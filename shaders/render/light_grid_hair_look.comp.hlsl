// SPDX-License-Identifier: GPL-3.0-or-later
#define HAIRLOOM_LOOK
#include "shaders/render/light_grid_hair.hlsli"
