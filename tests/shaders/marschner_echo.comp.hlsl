// SPDX-License-Identifier: GPL-3.0-or-later
#include "shaders/render/marschner.hlsli"
#include "tests/shaders/fibre_echo.hlsli"
