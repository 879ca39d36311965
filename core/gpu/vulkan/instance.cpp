// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/gpu/vulkan/instance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "core/gpu/vulkan/backend.h"

namespace hairloom::gpu::vulkan {
namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

VKAPI_ATTR VkBool32 VKAPI_CALL onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                         VkDebugUtilsMessageTypeFlagsEXT,
                                         const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
    static_cast<MessageLog*>(user)->add(data->pMessage == nullptr ? "(no text)" : data->pMessage);
    return VK_FALSE;
}

VkDebugUtilsMessengerCreateInfoEXT messengerInfo(MessageLog* log) {
    auto info =
        make<VkDebugUtilsMessengerCreateInfoEXT>(VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT);
    info.messageSeverity =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT;
    info.messageType =
        VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT;
    info.pfnUserCallback = onMessage;
    info.pUserData = log;
    return info;
}

bool hasLayer(const char* name) {
    std::uint32_t count = 0;
    vkEnumerateInstanceLayerProperties(&count, nullptr);
    std::vector<VkLayerProperties> layers(count);
    if (count > 0) vkEnumerateInstanceLayerProperties(&count, layers.data());
    for (const auto& layer : layers) {
        if (std::strcmp(layer.layerName, name) == 0) return true;
    }
    return false;
}

/// The extensions that make surfaces of windows; empty where the loader lacks one.
std::vector<const char*> surfaceExtensions() {
#ifdef VK_USE_PLATFORM_WIN32_KHR
    const char* const ofSystem = VK_KHR_WIN32_SURFACE_EXTENSION_NAME;
#else
    const char* const ofSystem = VK_KHR_XCB_SURFACE_EXTENSION_NAME;
#endif
    std::vector<const char*> wanted = {VK_KHR_SURFACE_EXTENSION_NAME, ofSystem};
    std::uint32_t count = 0;
    vkEnumerateInstanceExtensionProperties(nullptr, &count, nullptr);
    std::vector<VkExtensionProperties> offered(count);
    if (count > 0) vkEnumerateInstanceExtensionProperties(nullptr, &count, offered.data());
    const auto isOffered = [&](const char* name) {
        return std::ranges::any_of(offered,
                                   [&](const auto& e) { return std::strcmp(e.extensionName, name) == 0; });
    };
    if (std::ranges::all_of(wanted, isOffered)) return wanted;
    return {};
}

bool hasSwapChainExtension(VkPhysicalDevice physical) {
    std::uint32_t count = 0;
    vkEnumerateDeviceExtensionProperties(physical, nullptr, &count, nullptr);
    std::vector<VkExtensionProperties> offered(count);
    if (count > 0) vkEnumerateDeviceExtensionProperties(physical, nullptr, &count, offered.data());
    return std::ranges::any_of(offered, [](const auto& extension) {
        return std::strcmp(extension.extensionName, VK_KHR_SWAPCHAIN_EXTENSION_NAME) == 0;
    });
}

tl::unexpected<Error> noDriver() {
    return fail("no Vulkan driver on this machine",
                "a GPU driver, or a software one (Debian: mesa-vulkan-drivers)");
}

// volk keeps its entry points in globals.
std::mutex& volkMutex() {
    static std::mutex mutex;
    return mutex;
}

}  // namespace

void MessageLog::add(std::string message) {
    const std::lock_guard lock(mutex_);
    messages_.push_back(std::move(message));
}

std::vector<std::string> MessageLog::all() const {
    const std::lock_guard lock(mutex_);
    return messages_;
}

Result<std::unique_ptr<Instance>> Instance::create(bool validation) {
    const std::lock_guard lock(volkMutex());
    if (volkInitialize() != VK_SUCCESS) {
        return fail("no Vulkan loader on this machine", "libvulkan.so.1 (Debian: libvulkan1)");
    }
    if (volkGetInstanceVersion() < VK_API_VERSION_1_3) {
        return fail("the Vulkan loader is too old", "version 1.3 or later");
    }
    if (validation && !hasLayer(kValidationLayer)) {
        return fail("Vulkan's validation layer is not installed", "Debian: vulkan-validationlayers");
    }
    auto application = make<VkApplicationInfo>(VK_STRUCTURE_TYPE_APPLICATION_INFO);
    application.pApplicationName = "Hairloom";
    application.apiVersion = VK_API_VERSION_1_3;

    std::unique_ptr<Instance> result(new Instance);
    auto info = make<VkInstanceCreateInfo>(VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO);
    info.pApplicationInfo = &application;
    std::vector<const char*> extensions = surfaceExtensions();
    result->presents_ = !extensions.empty();
    auto messenger = messengerInfo(&result->log_);
    const VkValidationFeatureEnableEXT enabled[] = {
        VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
    auto features = make<VkValidationFeaturesEXT>(VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT);
    features.enabledValidationFeatureCount = 1;
    features.pEnabledValidationFeatures = enabled;
    if (validation) {
        info.enabledLayerCount = 1;
        info.ppEnabledLayerNames = &kValidationLayer;
        extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
        features.pNext = &messenger;
        info.pNext = &features;
    }
    info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();
    if (const VkResult r = vkCreateInstance(&info, nullptr, &result->instance_); r != VK_SUCCESS) {
        if (r == VK_ERROR_INCOMPATIBLE_DRIVER) return noDriver();
        return failed(r, "starting Vulkan");
    }
    volkLoadInstance(result->instance_);
    if (validation) {
        messenger.pNext = nullptr;
        const VkResult r =
            vkCreateDebugUtilsMessengerEXT(result->instance_, &messenger, nullptr, &result->messenger_);
        if (r != VK_SUCCESS) return failed(r, "listening to the validation layer");
    }
    return result;
}

Instance::~Instance() {
    if (messenger_ != VK_NULL_HANDLE) vkDestroyDebugUtilsMessengerEXT(instance_, messenger_, nullptr);
    if (instance_ != VK_NULL_HANDLE) vkDestroyInstance(instance_, nullptr);
}

Result<std::vector<VkPhysicalDevice>> Instance::physicalDevices() const {
    std::uint32_t count = 0;
    VkResult r = vkEnumeratePhysicalDevices(instance_, &count, nullptr);
    std::vector<VkPhysicalDevice> devices(count);
    if (r == VK_SUCCESS && count > 0) r = vkEnumeratePhysicalDevices(instance_, &count, devices.data());
    if (r != VK_SUCCESS && r != VK_INCOMPLETE) return failed(r, "looking for Vulkan devices");
    devices.resize(count);
    if (devices.empty()) {
        return noDriver();
    }
    return devices;
}

int findQueueFamily(VkPhysicalDevice physical) {
    std::uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
    constexpr VkQueueFlags kNeeded = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    for (std::uint32_t i = 0; i < count; ++i) {
        if ((families[i].queueFlags & kNeeded) == kNeeded) return static_cast<int>(i);
    }
    return -1;
}

/// Where the device lets compute pipelines choose, and has what waves tell each other with.
WaveSizes wavesOf(VkPhysicalDevice physical, const VkPhysicalDeviceVulkan13Features& features) {
    if (features.subgroupSizeControl == VK_FALSE || features.computeFullSubgroups == VK_FALSE) return {};
    auto p13 =
        make<VkPhysicalDeviceVulkan13Properties>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_PROPERTIES);
    auto p11 =
        make<VkPhysicalDeviceVulkan11Properties>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES);
    auto p2 = make<VkPhysicalDeviceProperties2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2);
    p2.pNext = &p13;
    p13.pNext = &p11;
    vkGetPhysicalDeviceProperties2(physical, &p2);
    constexpr VkSubgroupFeatureFlags kNeeded = VK_SUBGROUP_FEATURE_BASIC_BIT | VK_SUBGROUP_FEATURE_VOTE_BIT |
                                               VK_SUBGROUP_FEATURE_BALLOT_BIT |
                                               VK_SUBGROUP_FEATURE_SHUFFLE_BIT;
    if ((p11.subgroupSupportedOperations & kNeeded) != kNeeded) return {};
    if ((p13.requiredSubgroupSizeStages & VK_SHADER_STAGE_COMPUTE_BIT) == 0) return {};
    return {p13.minSubgroupSize, p13.maxSubgroupSize};
}

DeviceInfo describe(VkPhysicalDevice physical, std::uint32_t index, bool surfaces) {
    auto driver = make<VkPhysicalDeviceDriverProperties>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES);
    auto p2 = make<VkPhysicalDeviceProperties2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2);
    VkPhysicalDeviceProperties first;
    vkGetPhysicalDeviceProperties(physical, &first);
    DeviceInfo info;
    info.index = index;
    info.name = first.deviceName;
    info.backend = Backend::Vulkan;
    info.validates = hasLayer(kValidationLayer);
    info.apiVersion =
        fmt::format("{}.{}.{}", VK_API_VERSION_MAJOR(first.apiVersion),
                    VK_API_VERSION_MINOR(first.apiVersion), VK_API_VERSION_PATCH(first.apiVersion));
    switch (first.deviceType) {
        case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
            info.type = DeviceType::Discrete;
            break;
        case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
            info.type = DeviceType::Integrated;
            break;
        case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
            info.type = DeviceType::Virtual;
            break;
        case VK_PHYSICAL_DEVICE_TYPE_CPU:
            info.type = DeviceType::Cpu;
            break;
        default:
            info.type = DeviceType::Other;
            break;
    }
    if (first.apiVersion < VK_API_VERSION_1_3) {
        info.unusableReason = "Vulkan " + info.apiVersion + ", 1.3 is needed";
        return info;
    }
    p2.pNext = &driver;
    vkGetPhysicalDeviceProperties2(physical, &p2);
    info.driver = fmt::format("{} {}", driver.driverName, driver.driverInfo);
    const VkPhysicalDeviceLimits& limits = p2.properties.limits;

    auto f2 = make<VkPhysicalDeviceFeatures2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2);
    auto f13 = make<VkPhysicalDeviceVulkan13Features>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES);
    f2.pNext = &f13;
    vkGetPhysicalDeviceFeatures2(physical, &f2);
    const int family = findQueueFamily(physical);
    if (family < 0) info.unusableReason = "no queue for both graphics and compute";
    if (f13.dynamicRendering == VK_FALSE) info.unusableReason = "no dynamic rendering";
    if (f13.synchronization2 == VK_FALSE) info.unusableReason = "no synchronization2";
    info.usable = info.unusableReason.empty();
    info.waves = wavesOf(physical, f13);

    const VkSampleCountFlags samples =
        limits.framebufferColorSampleCounts & limits.framebufferDepthSampleCounts;
    for (const std::uint32_t n : {1u, 2u, 4u, 8u, 16u}) {
        if ((samples & n) != 0) info.sampleCounts.push_back(n);
    }
    info.tessellation = f2.features.tessellationShader == VK_TRUE && limits.maxTessellationPatchSize >= 32;
    info.depthClamp = f2.features.depthClamp == VK_TRUE;
    info.statistics = f2.features.pipelineStatisticsQuery == VK_TRUE;
    info.wireframe = f2.features.fillModeNonSolid == VK_TRUE;
    info.presents = surfaces && hasSwapChainExtension(physical);
    info.timestampPeriodNs =
        limits.timestampComputeAndGraphics == VK_TRUE ? static_cast<double>(limits.timestampPeriod) : 0.0;
    info.maxBufferBytes = limits.maxStorageBufferRange;
    info.maxTextureSize = limits.maxImageDimension2D;
    VkPhysicalDeviceMemoryProperties memory;
    vkGetPhysicalDeviceMemoryProperties(physical, &memory);
    for (std::uint32_t i = 0; i < memory.memoryHeapCount; ++i) {
        if ((memory.memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT) == 0) continue;
        info.memoryBytes = std::max<std::uint64_t>(info.memoryBytes, memory.memoryHeaps[i].size);
    }
    return info;
}

Result<std::vector<DeviceInfo>> listDevices() {
    const auto instance = Instance::create(false);
    if (!instance) return tl::unexpected(instance.error());
    const auto physical = (*instance)->physicalDevices();
    if (!physical) return tl::unexpected(physical.error());
    std::vector<DeviceInfo> infos;
    for (VkPhysicalDevice device : *physical) {
        infos.push_back(describe(device, static_cast<std::uint32_t>(infos.size()), (*instance)->presents()));
    }
    return infos;
}

}  // namespace hairloom::gpu::vulkan
