// SPDX-License-Identifier: GPL-3.0-or-later
#define HAIRLOOM_LOOK
#define HAIRLOOM_SADEGHI
#include "shaders/render/shade_fibre.hlsli"
