// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Which backend the tests of a run are for: the environment variable HAIRLOOM_TEST_BACKEND says "vulkan" or
// "d3d11"; without it the system's own comes first. Every test that needs a device asks here, so that all of
// them run on each backend.

#include <cstdlib>
#include <stdexcept>
#include <string_view>

#include "core/gpu/device.h"

namespace hairloom::gpu {

/// With the checks that the tests fail on.
inline DeviceOptions testDevice() {
    DeviceOptions options;
    options.validation = true;
    const char* const named = std::getenv("HAIRLOOM_TEST_BACKEND");  // NOLINT(concurrency-mt-unsafe)
    const std::string_view name = named == nullptr ? "" : named;
    if (name.empty()) return options;
    if (name != "vulkan" && name != "d3d11") throw std::invalid_argument("HAIRLOOM_TEST_BACKEND");
    options.backend = name == "vulkan" ? Backend::Vulkan : Backend::Direct3D11;
    return options;
}

}  // namespace hairloom::gpu
