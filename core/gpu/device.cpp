// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/gpu/device.h"

#include "core/gpu/validation.h"
#include "core/gpu/vulkan/backend.h"

namespace hairloom::gpu {

std::uint32_t bytesPerTexel(Format format) {
    switch (format) {
        case Format::Unknown:
            return 0;
        case Format::R8Unorm:
            return 1;
        case Format::Rgba8Unorm:
        case Format::Rgba8UnormSrgb:
        case Format::Bgra8Unorm:
        case Format::R32Uint:
        case Format::R32Float:
        case Format::D32Float:
            return 4;
        case Format::Rgba16Unorm:
        case Format::Rgba16Float:
        case Format::Rg32Float:
            return 8;
        case Format::Rgb32Float:
            return 12;
        case Format::Rgba32Float:
            return 16;
    }
    return 0;
}

std::string_view toString(DeviceType type) {
    switch (type) {
        case DeviceType::Discrete:
            return "discrete";
        case DeviceType::Integrated:
            return "integrated";
        case DeviceType::Virtual:
            return "virtual";
        case DeviceType::Cpu:
            return "cpu";
        case DeviceType::Other:
            break;
    }
    return "other";
}

std::string toString(const ShaderRegister& shaderRegister) {
    constexpr std::string_view kClasses = "btsu";  // in the order of Binding::Kind
    return kClasses[static_cast<std::size_t>(shaderRegister.kind)] + std::to_string(shaderRegister.slot);
}

Result<std::vector<DeviceInfo>> listDevices() {
    return vulkan::listDevices();
}

Result<std::unique_ptr<Device>> createDevice(const DeviceOptions& options) {
    auto device = vulkan::createDevice(options);
    if (!device || !options.validation) return device;
    return std::make_unique<ValidationDevice>(std::move(*device));
}

}  // namespace hairloom::gpu
