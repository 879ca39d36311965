// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A device that is this computer's processor: what core/render asks of a GPU, by native code on all cores.
//
// Shaders are the GPU's own source, compiled as C++ (kernel.h). Where a processor does better in another way
// than thousands of threads, a pass has a form of its own. All work is done when it is recorded; same
// commands, same bits on any number of threads.

#include <memory>
#include <string>
#include <string_view>

#include "core/gpu/device.h"
#include "core/software/stop.h"

namespace hairloom::software {

inline constexpr std::string_view kDeviceName = "software renderer";

/// Draws hair, heads and marks, not tubes, strips and tessellated ribbons: pipelines that it has no code for
/// are errors. Once `stop` is asked for, lists fail with kDropped within the time of a tile, and what a frame
/// adds to a sum is not added.
std::unique_ptr<gpu::Device> makeDevice(Stop stop = {});

struct DeviceChoice {
    std::unique_ptr<gpu::Device> device;
    std::string why;  ///< the software renderer draws; empty: it does not
};
/// The best GPU, or the software renderer if there is none: no graphics API, no driver, or only one that runs
/// on the processor.
DeviceChoice chooseDevice();

/// Whether `device` is such a one.
bool isSoftware(const gpu::Device& device);

}  // namespace hairloom::software
