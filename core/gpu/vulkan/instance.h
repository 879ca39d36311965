// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Loader, instance, and what each physical device offers.

#include <memory>
#include <mutex>
#include <vector>

#include "core/gpu/device.h"
#include "core/gpu/vulkan/api.h"

namespace hairloom::gpu::vulkan {

/// What the validation layers said; written from any thread.
class MessageLog {
  public:
    void add(std::string message);
    std::vector<std::string> all() const;

  private:
    mutable std::mutex mutex_;
    std::vector<std::string> messages_;
};

class Instance {
  public:
    static Result<std::unique_ptr<Instance>> create(bool validation);
    ~Instance();
    Instance(const Instance&) = delete;
    Instance& operator=(const Instance&) = delete;

    VkInstance handle() const { return instance_; }
    /// Surfaces of windows can be made.
    bool presents() const { return presents_; }
    std::vector<std::string> messages() const { return log_.all(); }
    Result<std::vector<VkPhysicalDevice>> physicalDevices() const;

  private:
    Instance() = default;
    VkInstance instance_ = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
    bool presents_ = false;
    MessageLog log_;
};

/// `surfaces`: the instance can make surfaces of windows.
DeviceInfo describe(VkPhysicalDevice physical, std::uint32_t index, bool surfaces);
/// Family with graphics, compute and copies; -1 where there is none.
int findQueueFamily(VkPhysicalDevice physical);

}  // namespace hairloom::gpu::vulkan
