// SPDX-License-Identifier: GPL-3.0-or-later
#include "shaders/render/shade_across.hlsli"
