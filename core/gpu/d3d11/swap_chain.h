// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "core/gpu/d3d11/resources.h"

namespace hairloom::gpu::d3d11 {

/// The window's own buffers have the window's size, the back buffer has the size that the program chose;
/// presenting copies from one to the other.
class SwapChainImpl final : public SwapChain {
  public:
    static Result<std::unique_ptr<SwapChain>> create(const ContextPtr& context, const SwapChainDesc& desc);
    const TexturePtr& backBuffer() const override { return backBuffer_; }
    Status resize(std::uint32_t width, std::uint32_t height) override;
    Status present() override;

  private:
    SwapChainImpl(ContextPtr context, const SwapChainDesc& desc)
        : context_(std::move(context)), desc_(desc) {}
    Status openWindow();
    Status followWindow(UINT width, UINT height);
    Status copyToWindow();
    HWND window() const {
        return reinterpret_cast<HWND>(desc_.window.window);
    }  // NOLINT(performance-no-int-to-ptr)

    ContextPtr context_;
    SwapChainDesc desc_;
    ComPtr<IDXGISwapChain1> chain_;
    UINT width_ = 0, height_ = 0;
    TexturePtr backBuffer_;
};

}  // namespace hairloom::gpu::d3d11
