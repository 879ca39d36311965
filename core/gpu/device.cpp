// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/gpu/device.h"

#include "core/gpu/checks.h"
#ifdef _WIN32
#include "core/gpu/d3d11/backend.h"
#endif
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

std::string_view toString(Backend backend) {
    return backend == Backend::Vulkan ? "Vulkan" : "Direct3D 11";
}

namespace {

struct BackendEntry {
    Result<std::vector<DeviceInfo>> (*list)();
    Result<std::unique_ptr<Device>> (*open)(std::uint32_t, const DeviceInfo&, const DeviceOptions&);
    Backend backend;
};

/// The system's own first.
constexpr BackendEntry kBackends[] = {
#ifdef _WIN32
    {d3d11::listDevices, d3d11::openDevice, Backend::Direct3D11},
#endif
    {vulkan::listDevices, vulkan::openDevice, Backend::Vulkan},
};

struct Listed {
    DeviceInfo info;
    const BackendEntry* backend = nullptr;
    std::uint32_t place = 0;  ///< in the backend's own list
};

/// Errors: no backend has a device, and why the first one, or the one asked for, has none.
Result<std::vector<Listed>> listAll(const std::optional<Backend>& only) {
    std::vector<Listed> all;
    std::optional<Error> first;
    std::uint32_t index = 0;
    for (const BackendEntry& entry : kBackends) {
        auto infos = entry.list();
        if (!infos) {
            if (!first && (!only || *only == entry.backend)) first = infos.error();
            continue;
        }
        for (std::uint32_t place = 0; place < infos->size(); ++place) {
            (*infos)[place].index = index++;
            all.push_back({std::move((*infos)[place]), &entry, place});
        }
    }
    if (all.empty() && first) return tl::unexpected(*first);
    return all;
}

std::vector<DeviceInfo> infosOf(const std::vector<Listed>& listed) {
    std::vector<DeviceInfo> infos;
    for (const Listed& device : listed) infos.push_back(device.info);
    return infos;
}

}  // namespace

Result<std::vector<DeviceInfo>> listDevices() {
    const auto listed = listAll({});
    if (!listed) return tl::unexpected(listed.error());
    return infosOf(*listed);
}

Result<std::unique_ptr<Device>> createDevice(const DeviceOptions& options) {
    const auto listed = listAll(options.backend);
    if (!listed) return tl::unexpected(listed.error());
    const auto chosen = chooseDevice(infosOf(*listed), options);
    if (!chosen) return tl::unexpected(chosen.error());
    const Listed& device = (*listed)[chosen->index];
    auto opened = device.backend->open(device.place, device.info, options);
    if (!opened || !options.validation) return opened;
    return std::make_unique<ValidationDevice>(std::move(*opened));
}

}  // namespace hairloom::gpu
