// SPDX-License-Identifier: GPL-3.0-or-later
// Textures and samplers.
#include "core/gpu/d3d11/resources.h"

namespace hairloom::gpu::d3d11 {
namespace {

/// A depth texture that shaders read is one float to them and depth to the depth test: it is typeless.
DXGI_FORMAT resourceFormat(Format format) {
    return format == Format::D32Float ? DXGI_FORMAT_R32_TYPELESS : toDxgi(format);
}

DXGI_FORMAT readFormat(Format format) {
    return format == Format::D32Float ? DXGI_FORMAT_R32_FLOAT : toDxgi(format);
}

D3D11_TEXTURE2D_DESC toD3d11(const TextureDesc& desc) {
    D3D11_TEXTURE2D_DESC info{};
    info.Width = desc.width;
    info.Height = desc.height;
    info.MipLevels = info.ArraySize = 1;
    info.Format = resourceFormat(desc.format);
    info.SampleDesc.Count = desc.samples;
    info.Usage = D3D11_USAGE_DEFAULT;
    if (has(desc.usage, Usage::ShaderRead)) info.BindFlags |= D3D11_BIND_SHADER_RESOURCE;
    if (has(desc.usage, Usage::UnorderedAccess)) info.BindFlags |= D3D11_BIND_UNORDERED_ACCESS;
    if (has(desc.usage, Usage::RenderTarget)) info.BindFlags |= D3D11_BIND_RENDER_TARGET;
    if (has(desc.usage, Usage::DepthStencil)) info.BindFlags |= D3D11_BIND_DEPTH_STENCIL;
    return info;
}

}  // namespace

Result<std::shared_ptr<TextureImpl>> TextureImpl::create(const ContextPtr& context, const TextureDesc& desc,
                                                         std::span<const std::byte> content) {
    const std::string what = "creating texture '" + desc.name + "' of " + std::to_string(desc.width) + "x" +
                             std::to_string(desc.height);
    std::shared_ptr<TextureImpl> result(new TextureImpl(desc));
    const D3D11_TEXTURE2D_DESC info = toD3d11(desc);
    const D3D11_SUBRESOURCE_DATA data{content.data(), desc.width * bytesPerTexel(desc.format), 0};
    HRESULT r = context->device->CreateTexture2D(&info, content.empty() ? nullptr : &data, &result->handle);
    if (SUCCEEDED(r)) r = result->createViews(context->device.Get());
    if (r == E_INVALIDARG) {
        return fail(what + ": the device has no such combination of format, usage and samples",
                    "expected another device, or fewer samples (--aa)");
    }
    if (FAILED(r)) return context->failed(r, what);
    return result;
}

HRESULT TextureImpl::createViews(ID3D11Device* device) {
    const bool many = desc().samples > 1;
    HRESULT r = S_OK;
    if (has(desc().usage, Usage::ShaderRead)) {
        D3D11_SHADER_RESOURCE_VIEW_DESC info{};
        info.Format = readFormat(desc().format);
        info.ViewDimension = many ? D3D11_SRV_DIMENSION_TEXTURE2DMS : D3D11_SRV_DIMENSION_TEXTURE2D;
        if (!many) info.Texture2D = {0, 1};
        r = device->CreateShaderResourceView(handle.Get(), &info, &readView);
    }
    if (SUCCEEDED(r) && has(desc().usage, Usage::UnorderedAccess)) {
        r = device->CreateUnorderedAccessView(handle.Get(), nullptr, &writeView);
    }
    if (SUCCEEDED(r) && has(desc().usage, Usage::RenderTarget)) {
        r = device->CreateRenderTargetView(handle.Get(), nullptr, &targetView);
    }
    if (SUCCEEDED(r) && has(desc().usage, Usage::DepthStencil)) {
        D3D11_DEPTH_STENCIL_VIEW_DESC info{};
        info.Format = DXGI_FORMAT_D32_FLOAT;
        info.ViewDimension = many ? D3D11_DSV_DIMENSION_TEXTURE2DMS : D3D11_DSV_DIMENSION_TEXTURE2D;
        r = device->CreateDepthStencilView(handle.Get(), &info, &depthView);
    }
    return r;
}

Result<ComPtr<ID3D11Texture2D>> TextureImpl::createStaging(Context& context) const {
    D3D11_TEXTURE2D_DESC info = toD3d11(desc());
    info.Usage = D3D11_USAGE_STAGING;
    info.BindFlags = 0;
    info.CPUAccessFlags = D3D11_CPU_ACCESS_READ;
    ComPtr<ID3D11Texture2D> staging;
    const HRESULT r = context.device->CreateTexture2D(&info, nullptr, &staging);
    if (FAILED(r)) return context.failed(r, "reading texture '" + desc().name + "' back");
    return staging;
}

Result<std::shared_ptr<SamplerImpl>> SamplerImpl::create(const ContextPtr& context, const SamplerDesc& desc) {
    auto result = std::make_shared<SamplerImpl>();
    D3D11_SAMPLER_DESC info{};
    info.Filter =
        desc.filter == Filter::Linear ? D3D11_FILTER_MIN_MAG_MIP_LINEAR : D3D11_FILTER_MIN_MAG_MIP_POINT;
    const D3D11_TEXTURE_ADDRESS_MODE mode = desc.address == AddressMode::Clamp ? D3D11_TEXTURE_ADDRESS_CLAMP
                                            : desc.address == AddressMode::Wrap
                                                ? D3D11_TEXTURE_ADDRESS_WRAP
                                                : D3D11_TEXTURE_ADDRESS_BORDER;
    info.AddressU = info.AddressV = info.AddressW = mode;
    info.MaxAnisotropy = 1;
    info.ComparisonFunc = D3D11_COMPARISON_NEVER;
    for (FLOAT& channel : info.BorderColor) channel = desc.borderIsWhite ? 1.0f : 0.0f;
    info.MaxLOD = D3D11_FLOAT32_MAX;
    const HRESULT r = context->device->CreateSamplerState(&info, &result->handle);
    if (FAILED(r)) return context->failed(r, "creating a sampler");
    return result;
}

}  // namespace hairloom::gpu::d3d11
