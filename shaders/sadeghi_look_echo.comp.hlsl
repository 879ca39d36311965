// SPDX-License-Identifier: GPL-3.0-or-later
#define HAIRLOOM_LOOK
#include "shaders/sadeghi.hlsli"
#include "shaders/fibre_echo.hlsli"
