// SPDX-License-Identifier: GPL-3.0-or-later
#include "shaders/render/light_grid_hair.hlsli"
