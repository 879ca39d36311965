// SPDX-License-Identifier: GPL-3.0-or-later
#include "shaders/marschner.hlsli"
#include "shaders/fibre_echo.hlsli"
