// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A device that is this computer's processor: what core/render asks of a GPU, by native code on all cores.
//
// Shaders are the GPU's own source, compiled as C++ (kernel.h). Where a processor does better in another way
// than thousands of threads, a pass has a form of its own. All work is done when it is recorded; same
// commands, same bits on any number of threads.

#include <memory>

#include "core/gpu/device.h"

namespace hairloom::software {

inline constexpr std::string_view kDeviceName = "software renderer";

/// Draws hair and heads, not tubes, strips and tessellated ribbons: pipelines that it has no code for are
/// errors.
std::unique_ptr<gpu::Device> makeDevice();

/// Whether `device` is such a one.
bool isSoftware(const gpu::Device& device);

}  // namespace hairloom::software
