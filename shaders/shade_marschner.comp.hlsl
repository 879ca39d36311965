// SPDX-License-Identifier: GPL-3.0-or-later
#include "shaders/shade_fibre.hlsli"
