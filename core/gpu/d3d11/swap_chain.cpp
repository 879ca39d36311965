// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/gpu/d3d11/swap_chain.h"

#include <algorithm>

#include "core/gpu/checks.h"

namespace hairloom::gpu::d3d11 {
namespace {

constexpr DXGI_FORMAT kFormat = DXGI_FORMAT_B8G8R8A8_UNORM;
constexpr UINT kMaxFramesInFlight = 2;

struct Size {
    UINT width = 0, height = 0;
};

Size sizeOf(HWND window) {
    RECT area{};
    if (GetClientRect(window, &area) == 0) return {};
    return {static_cast<UINT>(area.right - area.left), static_cast<UINT>(area.bottom - area.top)};
}

}  // namespace

Result<std::unique_ptr<SwapChain>> SwapChainImpl::create(const ContextPtr& context,
                                                         const SwapChainDesc& desc) {
    std::unique_ptr<SwapChainImpl> result(new SwapChainImpl(context, desc));
    if (IsWindow(result->window()) == 0) return fail("no such window");
    if (auto status = result->resize(desc.width, desc.height); !status) return tl::unexpected(status.error());
    if (auto status = result->openWindow(); !status) return tl::unexpected(status.error());
    return std::unique_ptr<SwapChain>(std::move(result));
}

Status SwapChainImpl::openWindow() {
    ComPtr<IDXGIDevice1> device;
    ComPtr<IDXGIAdapter> adapter;
    ComPtr<IDXGIFactory2> factory;
    HRESULT r = context_->device.As(&device);
    if (SUCCEEDED(r)) r = device->SetMaximumFrameLatency(kMaxFramesInFlight);
    if (SUCCEEDED(r)) r = device->GetAdapter(&adapter);
    if (SUCCEEDED(r)) r = adapter->GetParent(IID_PPV_ARGS(&factory));
    if (FAILED(r)) return context_->failed(r, "drawing to the window");
    const Size size = sizeOf(window());
    width_ = std::max(size.width, 1u);
    height_ = std::max(size.height, 1u);
    DXGI_SWAP_CHAIN_DESC1 info{};
    info.Width = width_;
    info.Height = height_;
    info.Format = kFormat;
    info.SampleDesc.Count = 1;
    info.BufferUsage = DXGI_USAGE_RENDER_TARGET_OUTPUT;
    info.BufferCount = 2;
    info.Scaling = DXGI_SCALING_STRETCH;
    info.SwapEffect = DXGI_SWAP_EFFECT_FLIP_DISCARD;
    r = factory->CreateSwapChainForHwnd(context_->device.Get(), window(), &info, nullptr, nullptr, &chain_);
    if (FAILED(r)) return context_->failed(r, "creating a swap chain");
    // The window's owner decides about full screen.
    factory->MakeWindowAssociation(window(), DXGI_MWA_NO_WINDOW_CHANGES | DXGI_MWA_NO_ALT_ENTER);
    return {};
}

Status SwapChainImpl::resize(std::uint32_t width, std::uint32_t height) {
    if (auto status = context_->checkAlive(); !status) return status;
    const TextureDesc desc = backBufferDesc(width, height);
    if (auto status = checkDesc(context_->info, desc, 0); !status) return status;
    auto texture = TextureImpl::create(context_, desc, {});
    if (!texture) return tl::unexpected(texture.error());
    backBuffer_ = std::move(*texture);
    return {};
}

Status SwapChainImpl::followWindow(UINT width, UINT height) {
    if (width == width_ && height == height_) return {};
    const HRESULT r = chain_->ResizeBuffers(0, width, height, DXGI_FORMAT_UNKNOWN, 0);
    if (FAILED(r)) return context_->failed(r, "following the window's size");
    width_ = width;
    height_ = height;
    return {};
}

Status SwapChainImpl::copyToWindow() {
    ComPtr<ID3D11Texture2D> target;
    HRESULT r = chain_->GetBuffer(0, IID_PPV_ARGS(&target));
    if (FAILED(r)) return context_->failed(r, "presenting");
    const TextureDesc& source = backBuffer_->desc();
    if (source.width < width_ || source.height < height_) {
        ComPtr<ID3D11RenderTargetView> view;
        r = context_->device->CreateRenderTargetView(target.Get(), nullptr, &view);
        if (FAILED(r)) return context_->failed(r, "presenting");
        constexpr float kBlack[] = {0, 0, 0, 1};
        context_->immediate->ClearRenderTargetView(view.Get(), kBlack);
    }
    const D3D11_BOX box{0, 0, 0, std::min(width_, source.width), std::min(height_, source.height), 1};
    context_->immediate->CopySubresourceRegion(target.Get(), 0, 0, 0, 0,
                                               static_cast<TextureImpl&>(*backBuffer_).handle.Get(), 0, &box);
    return {};
}

Status SwapChainImpl::present() {
    if (auto status = context_->checkAlive(); !status) return status;
    if (IsWindow(window()) == 0) return fail("presenting: the window is lost");
    const Size size = sizeOf(window());
    if (size.width == 0 || size.height == 0) return {};
    if (auto status = followWindow(size.width, size.height); !status) return status;
    if (auto status = copyToWindow(); !status) return status;
    const HRESULT r = chain_->Present(desc_.waitForDisplay ? 1 : 0, 0);
    if (FAILED(r)) return context_->failed(r, "presenting");
    return {};
}

}  // namespace hairloom::gpu::d3d11
