// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/gpu/d3d11/adapters.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "core/gpu/d3d11/backend.h"

namespace hairloom::gpu::d3d11 {
namespace {

std::string toUtf8(const wchar_t* text) {
    const auto utf8 = std::filesystem::path(text).u8string();
    return {utf8.begin(), utf8.end()};
}

std::string driverVersion(IDXGIAdapter1* adapter) {
    LARGE_INTEGER version{};
    if (FAILED(adapter->CheckInterfaceSupport(__uuidof(IDXGIDevice), &version))) return {};
    const auto high = static_cast<std::uint32_t>(version.HighPart),
               low = static_cast<std::uint32_t>(version.LowPart);
    return fmt::format("{}.{}.{}.{}", high >> 16u, high & 0xffffu, low >> 16u, low & 0xffffu);
}

/// Every format that a target of core/render has must take that many samples.
std::vector<std::uint32_t> sampleCounts(ID3D11Device* device) {
    constexpr DXGI_FORMAT kTargets[] = {DXGI_FORMAT_R8G8B8A8_UNORM, DXGI_FORMAT_R16G16B16A16_FLOAT,
                                        DXGI_FORMAT_R16G16B16A16_UNORM, DXGI_FORMAT_D32_FLOAT};
    std::vector<std::uint32_t> counts;
    for (const UINT samples : {1u, 2u, 4u, 8u, 16u}) {
        const bool all = std::ranges::all_of(kTargets, [&](DXGI_FORMAT format) {
            UINT levels = 0;
            return SUCCEEDED(device->CheckMultisampleQualityLevels(format, samples, &levels)) && levels > 0;
        });
        if (all || samples == 1) counts.push_back(samples);
    }
    return counts;
}

/// Nanoseconds between two ticks of the device's clock; 0 where it has none.
double timestampPeriod(Context& context) {
    constexpr D3D11_QUERY_DESC kClock{D3D11_QUERY_TIMESTAMP_DISJOINT, 0};
    ComPtr<ID3D11Query> query;
    if (FAILED(context.device->CreateQuery(&kClock, &query))) return 0;
    context.immediate->Begin(query.Get());
    context.immediate->End(query.Get());
    constexpr int kPatience = 2000;  // milliseconds
    for (int i = 0; i < kPatience; ++i) {
        D3D11_QUERY_DATA_TIMESTAMP_DISJOINT clock{};
        const HRESULT r = context.immediate->GetData(query.Get(), &clock, sizeof(clock), 0);
        if (r == S_OK) return clock.Frequency == 0 ? 0 : 1e9 / static_cast<double>(clock.Frequency);
        if (FAILED(r)) return 0;
        Sleep(1);
    }
    return 0;
}

DeviceType typeOf(const DXGI_ADAPTER_DESC1& desc) {
    // Drivers that draw on the CPU without saying so are known by name.
    const std::string name = toUtf8(desc.Description);
    const bool software =
        name.find("llvmpipe") != std::string::npos || name.find("lavapipe") != std::string::npos;
    if (software || (desc.Flags & DXGI_ADAPTER_FLAG_SOFTWARE) != 0) return DeviceType::Cpu;
    return desc.DedicatedVideoMemory >= (std::size_t{512} << 20u) ? DeviceType::Discrete
                                                                  : DeviceType::Integrated;
}

/// Direct3D 11.3 functional specification, 21.7: 128 MiB are always possible, a quarter of the memory up to 2
/// GiB.
std::uint64_t maxBufferBytes(const DXGI_ADAPTER_DESC1& desc) {
    constexpr std::uint64_t kMin = std::uint64_t{128} << 20u, kMax = std::uint64_t{2} << 30u;
    return std::clamp<std::uint64_t>(desc.DedicatedVideoMemory / 4, kMin, kMax);
}

}  // namespace

Result<std::vector<ComPtr<IDXGIAdapter1>>> listAdapters() {
    ComPtr<IDXGIFactory1> factory;
    const HRESULT r = CreateDXGIFactory1(IID_PPV_ARGS(&factory));
    if (FAILED(r)) return failed(r, "starting DXGI");
    std::vector<ComPtr<IDXGIAdapter1>> adapters;
    ComPtr<IDXGIAdapter1> adapter;
    for (UINT i = 0; factory->EnumAdapters1(i, adapter.ReleaseAndGetAddressOf()) == S_OK; ++i)
        adapters.push_back(adapter);
    if (adapters.empty()) return fail("no GPU that Direct3D knows on this machine", "a GPU driver");
    return adapters;
}

Status openDevice(IDXGIAdapter1* adapter, bool debug, Context& context) {
    constexpr D3D_FEATURE_LEVEL kLevel = D3D_FEATURE_LEVEL_11_0;
    const UINT flags = debug ? UINT{D3D11_CREATE_DEVICE_DEBUG} : 0u;
    const HRESULT r = D3D11CreateDevice(adapter, D3D_DRIVER_TYPE_UNKNOWN, nullptr, flags, &kLevel, 1,
                                        D3D11_SDK_VERSION, &context.device, nullptr, &context.immediate);
    if (FAILED(r)) return failed(r, "opening Direct3D at feature level 11_0");
    // Some systems take the flag and have no layer.
    if (debug && FAILED(context.device.As(&context.messages))) {
        return fail("Direct3D's debug layer is not installed",
                    "Windows: the optional feature Graphics Tools");
    }
    return {};
}

DeviceInfo describe(IDXGIAdapter1* adapter, std::uint32_t index) {
    DXGI_ADAPTER_DESC1 desc{};
    adapter->GetDesc1(&desc);
    DeviceInfo info;
    info.index = index;
    info.name = toUtf8(desc.Description);
    info.backend = Backend::Direct3D11;
    info.apiVersion = "11.0";
    info.driver = driverVersion(adapter);
    info.type = typeOf(desc);
    info.maxBufferBytes = maxBufferBytes(desc);
    info.maxTextureSize = D3D11_REQ_TEXTURE2D_U_OR_V_DIMENSION;
    info.memoryBytes = desc.DedicatedVideoMemory;
    Context context;
    if (auto status = openDevice(adapter, false, context); !status) {
        info.unusableReason = status.error().message();
        return info;
    }
    info.usable = true;
    // Feature level 11_0 has these wherever it is.
    info.tessellation = info.depthClamp = info.wireframe = info.presents = info.statistics = true;
    info.sampleCounts = sampleCounts(context.device.Get());
    info.timestampPeriodNs = timestampPeriod(context);
    Context checked;
    info.validates = openDevice(adapter, true, checked).has_value();
    return info;
}

Result<std::vector<DeviceInfo>> listDevices() {
    const auto adapters = listAdapters();
    if (!adapters) return tl::unexpected(adapters.error());
    std::vector<DeviceInfo> infos;
    for (const auto& adapter : *adapters) {
        infos.push_back(describe(adapter.Get(), static_cast<std::uint32_t>(infos.size())));
    }
    return infos;
}

}  // namespace hairloom::gpu::d3d11
