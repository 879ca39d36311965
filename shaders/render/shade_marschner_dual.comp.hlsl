// SPDX-License-Identifier: GPL-3.0-or-later
#define HAIRLOOM_DUAL
#include "shaders/render/shade_fibre.hlsli"
