// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Pictures while something moves: with which options they are drawn, and which pass belongs to which cost.
// The window, the benchmarks and the command line all take them from here.

#include <string_view>

#include "core/render/options.h"

namespace hairloom {

/// What a picture leaves out while something moves; size, exposure and joined frames stay as they are.
void simplifyWhileMoving(render::RenderOptions& options);

/// Of the options, what the software renderer does otherwise: hair is rasterised by kernels and, where
/// nothing else that it can was asked for, blended in its order, which has its cover in closed form and no
/// noise to average.
void takeWaysOfSoftware(render::RenderOptions& options);

/// What a frame's time is spent on.
enum class FrameCost { head, solve, hairHair, follow, measures, shadow, shade, draw };

/// "solve", "followHairs": as effects are named.
std::string_view frameCostName(FrameCost cost);

/// Of moving the hair, not of drawing it.
bool isSimulationCost(FrameCost cost);

/// By the name of a pass of the device, of simulation or picture.
FrameCost frameCostOf(std::string_view pass);

}  // namespace hairloom
