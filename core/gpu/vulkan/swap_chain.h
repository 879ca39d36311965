// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The back buffer is a texture of ours that is copied into whichever image the window system hands out: its
// content is kept from frame to frame, and the window may change its size at any time.

#include <array>
#include <vector>

#include "core/gpu/vulkan/resources.h"

namespace hairloom::gpu::vulkan {

class SwapChainImpl final : public SwapChain {
  public:
    static Result<std::unique_ptr<SwapChain>> create(const ContextPtr& context, const SwapChainDesc& desc);
    ~SwapChainImpl() override;
    SwapChainImpl(const SwapChainImpl&) = delete;
    SwapChainImpl& operator=(const SwapChainImpl&) = delete;

    const TexturePtr& backBuffer() const override { return backBuffer_; }
    Status resize(std::uint32_t width, std::uint32_t height) override;
    Status present() override;

  private:
    /// One copy on its way; its parts are used again once `done` is signalled.
    struct Flight {
        VkCommandPool pool = VK_NULL_HANDLE;
        VkCommandBuffer commands = VK_NULL_HANDLE;
        VkSemaphore acquired = VK_NULL_HANDLE;
        VkFence done = VK_NULL_HANDLE;
        TexturePtr source;  ///< kept alive while it is read
    };
    struct Image {
        VkImage handle = VK_NULL_HANDLE;
        VkSemaphore copied = VK_NULL_HANDLE;
    };

    SwapChainImpl(ContextPtr context, const SwapChainDesc& desc)
        : context_(std::move(context)), desc_(desc) {}
    VkResult createSurface();
    Status openSurface();
    Status choosePresentMode();
    Status createFlights();
    /// (Re)makes the images for the window's size of now; none while it has no area.
    Status createImages();
    Status addImage(VkImage handle);
    void destroyImages();
    /// False when the images no longer fit the window.
    Result<bool> tryPresent();
    Status recordCopy(Flight& flight, VkImage target);
    Status submitCopy(Flight& flight, const Image& target);

    ContextPtr context_;
    SwapChainDesc desc_;
    TexturePtr backBuffer_;
    VkSurfaceKHR surface_ = VK_NULL_HANDLE;
    VkSwapchainKHR swapChain_ = VK_NULL_HANDLE;
    VkPresentModeKHR presentMode_ = VK_PRESENT_MODE_FIFO_KHR;
    VkExtent2D extent_{};
    std::vector<Image> images_;
    std::array<Flight, 2> flights_;
    std::size_t nextFlight_ = 0;
};

}  // namespace hairloom::gpu::vulkan
