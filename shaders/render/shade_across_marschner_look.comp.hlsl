// SPDX-License-Identifier: GPL-3.0-or-later
#define HAIRLOOM_LOOK
#include "shaders/render/shade_across.hlsli"
