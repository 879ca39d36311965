// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/gpu/vulkan/swap_chain.h"

#ifdef _WIN32
#include <windows.h>
#endif

#include <algorithm>

#include "core/gpu/checks.h"
#include "core/gpu/vulkan/barriers.h"

namespace hairloom::gpu::vulkan {
namespace {

constexpr VkFormat kFormat = VK_FORMAT_B8G8R8A8_UNORM;
constexpr Use kCopyRead{VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT,
                        VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, false, false};

/// Also makes what was written before visible to what follows.
void changeLayout(VkCommandBuffer commands, VkImage image, VkImageLayout from, VkImageLayout to) {
    auto barrier = make<VkImageMemoryBarrier2>(VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2);
    // The wait for the acquired image is at these stages too, so the first change follows it.
    barrier.srcStageMask = barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
    if (from != VK_IMAGE_LAYOUT_UNDEFINED) barrier.srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT;
    if (to == VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL) barrier.dstAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT;
    barrier.oldLayout = from;
    barrier.newLayout = to;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image;
    barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    auto info = make<VkDependencyInfo>(VK_STRUCTURE_TYPE_DEPENDENCY_INFO);
    info.imageMemoryBarrierCount = 1;
    info.pImageMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(commands, &info);
}

Status createSemaphore(Context& context, VkSemaphore& semaphore) {
    const auto info = make<VkSemaphoreCreateInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO);
    const VkResult r = vkCreateSemaphore(context.device, &info, nullptr, &semaphore);
    if (r != VK_SUCCESS) return context.failed(r, "creating a swap chain");
    return {};
}

}  // namespace

Result<std::unique_ptr<SwapChain>> SwapChainImpl::create(const ContextPtr& context,
                                                         const SwapChainDesc& desc) {
    if (!context->info.presents) {
        return fail("GPU '" + context->info.name + "' cannot draw to windows", "a driver with swap chains");
    }
    std::unique_ptr<SwapChainImpl> result(new SwapChainImpl(context, desc));
    if (auto status = result->openSurface(); !status) return tl::unexpected(status.error());
    if (auto status = result->choosePresentMode(); !status) return tl::unexpected(status.error());
    if (auto status = result->createFlights(); !status) return tl::unexpected(status.error());
    if (auto status = result->resize(desc.width, desc.height); !status) return tl::unexpected(status.error());
    if (auto status = result->createImages(); !status) return tl::unexpected(status.error());
    return std::unique_ptr<SwapChain>(std::move(result));
}

VkResult SwapChainImpl::createSurface() {
    VkInstance instance = context_->instance->handle();
#ifdef VK_USE_PLATFORM_WIN32_KHR
    auto info = make<VkWin32SurfaceCreateInfoKHR>(VK_STRUCTURE_TYPE_WIN32_SURFACE_CREATE_INFO_KHR);
    info.hinstance = GetModuleHandleW(nullptr);
    info.hwnd = reinterpret_cast<HWND>(desc_.window.window);
    return vkCreateWin32SurfaceKHR(instance, &info, nullptr, &surface_);
#else
    auto info = make<VkXcbSurfaceCreateInfoKHR>(VK_STRUCTURE_TYPE_XCB_SURFACE_CREATE_INFO_KHR);
    info.connection = static_cast<xcb_connection_t*>(desc_.window.connection);
    info.window = static_cast<xcb_window_t>(desc_.window.window);
    return vkCreateXcbSurfaceKHR(instance, &info, nullptr, &surface_);
#endif
}

Status SwapChainImpl::openSurface() {
#ifdef VK_USE_PLATFORM_WIN32_KHR
    if (desc_.window.window == 0) return fail("no window");
#else
    if (desc_.window.connection == nullptr) return fail("no connection to an X server");
#endif
    VkResult r = createSurface();
    if (r != VK_SUCCESS) return context_->failed(r, "drawing to the window");
    VkBool32 supported = VK_FALSE;
    r = vkGetPhysicalDeviceSurfaceSupportKHR(context_->physical, context_->queueFamily, surface_, &supported);
    if (r != VK_SUCCESS) return context_->failed(r, "drawing to the window");
    if (supported == VK_FALSE) return fail("GPU '" + context_->info.name + "' cannot draw to this window");
    std::uint32_t count = 0;
    vkGetPhysicalDeviceSurfaceFormatsKHR(context_->physical, surface_, &count, nullptr);
    std::vector<VkSurfaceFormatKHR> formats(count);
    vkGetPhysicalDeviceSurfaceFormatsKHR(context_->physical, surface_, &count, formats.data());
    const bool fits = std::ranges::any_of(formats, [](const VkSurfaceFormatKHR& f) {
        return f.format == kFormat && f.colorSpace == VK_COLOR_SPACE_SRGB_NONLINEAR_KHR;
    });
    if (!fits) return fail("the window has no 8-bit BGRA format");
    return {};
}

Status SwapChainImpl::choosePresentMode() {
    if (desc_.waitForDisplay) return {};  // FIFO, which every device has
    std::uint32_t count = 0;
    vkGetPhysicalDeviceSurfacePresentModesKHR(context_->physical, surface_, &count, nullptr);
    std::vector<VkPresentModeKHR> modes(count);
    const VkResult r =
        vkGetPhysicalDeviceSurfacePresentModesKHR(context_->physical, surface_, &count, modes.data());
    if (r != VK_SUCCESS && r != VK_INCOMPLETE) return context_->failed(r, "creating a swap chain");
    for (const VkPresentModeKHR mode : {VK_PRESENT_MODE_MAILBOX_KHR, VK_PRESENT_MODE_IMMEDIATE_KHR}) {
        if (std::ranges::find(modes, mode) == modes.end()) continue;
        presentMode_ = mode;
        break;
    }
    return {};
}

Status SwapChainImpl::createFlights() {
    for (Flight& flight : flights_) {
        auto pool = make<VkCommandPoolCreateInfo>(VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO);
        pool.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
        pool.queueFamilyIndex = context_->queueFamily;
        VkResult r = vkCreateCommandPool(context_->device, &pool, nullptr, &flight.pool);
        if (r != VK_SUCCESS) return context_->failed(r, "creating a swap chain");
        auto info = make<VkCommandBufferAllocateInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO);
        info.commandPool = flight.pool;
        info.commandBufferCount = 1;
        r = vkAllocateCommandBuffers(context_->device, &info, &flight.commands);
        if (r != VK_SUCCESS) return context_->failed(r, "creating a swap chain");
        auto fence = make<VkFenceCreateInfo>(VK_STRUCTURE_TYPE_FENCE_CREATE_INFO);
        fence.flags = VK_FENCE_CREATE_SIGNALED_BIT;
        r = vkCreateFence(context_->device, &fence, nullptr, &flight.done);
        if (r != VK_SUCCESS) return context_->failed(r, "creating a swap chain");
        if (auto status = createSemaphore(*context_, flight.acquired); !status) return status;
    }
    return {};
}

Status SwapChainImpl::createImages() {
    VkSurfaceCapabilitiesKHR window;
    VkResult r = vkGetPhysicalDeviceSurfaceCapabilitiesKHR(context_->physical, surface_, &window);
    if (r != VK_SUCCESS) return context_->failed(r, "drawing to the window");
    // Nothing may read the images that go away.
    vkQueueWaitIdle(context_->queue);
    destroyImages();
    extent_ = window.currentExtent;
    if (extent_.width == 0 || extent_.height == 0) return {};
    auto info = make<VkSwapchainCreateInfoKHR>(VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR);
    info.surface = surface_;
    info.minImageCount = std::max(3u, window.minImageCount);
    if (window.maxImageCount > 0) info.minImageCount = std::min(info.minImageCount, window.maxImageCount);
    info.imageFormat = kFormat;
    info.imageColorSpace = VK_COLOR_SPACE_SRGB_NONLINEAR_KHR;
    info.imageExtent = extent_;
    info.imageArrayLayers = 1;
    info.imageUsage = VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    info.preTransform = window.currentTransform;
    info.compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR;
    info.presentMode = presentMode_;
    info.clipped = VK_TRUE;
    r = vkCreateSwapchainKHR(context_->device, &info, nullptr, &swapChain_);
    if (r != VK_SUCCESS) return context_->failed(r, "creating a swap chain");
    std::uint32_t count = 0;
    vkGetSwapchainImagesKHR(context_->device, swapChain_, &count, nullptr);
    std::vector<VkImage> handles(count);
    r = vkGetSwapchainImagesKHR(context_->device, swapChain_, &count, handles.data());
    if (r != VK_SUCCESS) return context_->failed(r, "creating a swap chain");
    for (VkImage handle : handles) {
        if (auto status = addImage(handle); !status) return status;
    }
    return {};
}

Status SwapChainImpl::addImage(VkImage handle) {
    images_.push_back({handle, VK_NULL_HANDLE});
    return createSemaphore(*context_, images_.back().copied);
}

void SwapChainImpl::destroyImages() {
    for (const Image& image : images_) vkDestroySemaphore(context_->device, image.copied, nullptr);
    images_.clear();
    vkDestroySwapchainKHR(context_->device, swapChain_, nullptr);
    swapChain_ = VK_NULL_HANDLE;
}

SwapChainImpl::~SwapChainImpl() {
    vkQueueWaitIdle(context_->queue);
    destroyImages();
    for (const Flight& flight : flights_) {
        vkDestroySemaphore(context_->device, flight.acquired, nullptr);
        vkDestroyFence(context_->device, flight.done, nullptr);
        vkDestroyCommandPool(context_->device, flight.pool, nullptr);
    }
    vkDestroySurfaceKHR(context_->instance->handle(), surface_, nullptr);
}

Status SwapChainImpl::resize(std::uint32_t width, std::uint32_t height) {
    if (auto status = context_->checkAlive(); !status) return status;
    const TextureDesc desc = backBufferDesc(width, height);
    if (auto status = checkDesc(context_->info, desc, 0); !status) return status;
    auto texture = TextureImpl::create(context_, desc);
    if (!texture) return tl::unexpected(texture.error());
    backBuffer_ = std::move(*texture);
    return {};
}

Status SwapChainImpl::present() {
    if (auto status = context_->checkAlive(); !status) return status;
    // The window may change its size between any two calls; a second change in a row is left to the next
    // frame.
    for (int attempt = 0; attempt < 2; ++attempt) {
        if (swapChain_ == VK_NULL_HANDLE) {
            if (auto status = createImages(); !status) return status;
            if (swapChain_ == VK_NULL_HANDLE) return {};
        }
        const auto shown = tryPresent();
        if (!shown) return tl::unexpected(shown.error());
        if (*shown) return {};
        if (auto status = createImages(); !status) return status;
    }
    return {};
}

Result<bool> SwapChainImpl::tryPresent() {
    Flight& flight = flights_[nextFlight_];
    const auto nanoseconds = static_cast<std::uint64_t>(std::clamp(context_->timeoutSeconds, 0.0, 1e6) * 1e9);
    VkResult r = vkWaitForFences(context_->device, 1, &flight.done, VK_TRUE, nanoseconds);
    if (r != VK_SUCCESS) return context_->failed(r, "waiting for the GPU");
    std::uint32_t index = 0;
    r = vkAcquireNextImageKHR(context_->device, swapChain_, nanoseconds, flight.acquired, VK_NULL_HANDLE,
                              &index);
    if (r == VK_ERROR_OUT_OF_DATE_KHR) return false;
    const bool stale = r == VK_SUBOPTIMAL_KHR;
    if (r != VK_SUCCESS && !stale) return context_->failed(r, "presenting");
    if (auto status = recordCopy(flight, images_[index].handle); !status)
        return tl::unexpected(status.error());
    if (auto status = submitCopy(flight, images_[index]); !status) return tl::unexpected(status.error());
    nextFlight_ = (nextFlight_ + 1) % flights_.size();
    auto info = make<VkPresentInfoKHR>(VK_STRUCTURE_TYPE_PRESENT_INFO_KHR);
    info.waitSemaphoreCount = 1;
    info.pWaitSemaphores = &images_[index].copied;
    info.swapchainCount = 1;
    info.pSwapchains = &swapChain_;
    info.pImageIndices = &index;
    r = vkQueuePresentKHR(context_->queue, &info);
    if (stale || r == VK_ERROR_OUT_OF_DATE_KHR || r == VK_SUBOPTIMAL_KHR) return false;
    if (r != VK_SUCCESS) return context_->failed(r, "presenting");
    return true;
}

Status SwapChainImpl::recordCopy(Flight& flight, VkImage target) {
    vkResetCommandPool(context_->device, flight.pool, 0);
    auto begin = make<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    VkResult r = vkBeginCommandBuffer(flight.commands, &begin);
    if (r != VK_SUCCESS) return context_->failed(r, "presenting");
    auto& source = static_cast<TextureImpl&>(*backBuffer_);
    BarrierTracker barriers;
    barriers.use(source, kCopyRead);
    barriers.flush(flight.commands);
    barriers.commit();
    changeLayout(flight.commands, target, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    VkImageCopy copy{};
    copy.srcSubresource = copy.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    copy.extent = {std::min(extent_.width, source.desc().width),
                   std::min(extent_.height, source.desc().height), 1};
    const bool covered = copy.extent.width == extent_.width && copy.extent.height == extent_.height;
    if (!covered) {
        const VkClearColorValue black{{0, 0, 0, 1}};
        const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        vkCmdClearColorImage(flight.commands, target, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &black, 1, &all);
        changeLayout(flight.commands, target, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                     VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    }
    vkCmdCopyImage(flight.commands, source.handle, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, target,
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
    changeLayout(flight.commands, target, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                 VK_IMAGE_LAYOUT_PRESENT_SRC_KHR);
    r = vkEndCommandBuffer(flight.commands);
    if (r != VK_SUCCESS) return context_->failed(r, "presenting");
    flight.source = backBuffer_;
    return {};
}

Status SwapChainImpl::submitCopy(Flight& flight, const Image& target) {
    auto wait = make<VkSemaphoreSubmitInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO);
    wait.semaphore = flight.acquired;
    wait.stageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
    auto signal = wait;
    signal.semaphore = target.copied;
    signal.stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    auto commands = make<VkCommandBufferSubmitInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO);
    commands.commandBuffer = flight.commands;
    auto info = make<VkSubmitInfo2>(VK_STRUCTURE_TYPE_SUBMIT_INFO_2);
    info.waitSemaphoreInfoCount = info.commandBufferInfoCount = info.signalSemaphoreInfoCount = 1;
    info.pWaitSemaphoreInfos = &wait;
    info.pCommandBufferInfos = &commands;
    info.pSignalSemaphoreInfos = &signal;
    vkResetFences(context_->device, 1, &flight.done);
    const VkResult r = vkQueueSubmit2(context_->queue, 1, &info, flight.done);
    if (r != VK_SUCCESS) return context_->failed(r, "presenting");
    return {};
}

}  // namespace hairloom::gpu::vulkan
