// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What stands behind the interface's objects. Each keeps the context, and with it the device, alive; each is
// destroyed only when no command list and no unfinished submission holds it.

#include <atomic>
#include <memory>

#include "core/gpu/checked_list.h"
#include "core/gpu/vulkan/instance.h"
#include "core/gpu/vulkan/memory.h"
#include "core/gpu/vulkan/reflection.h"

namespace hairloom::gpu::vulkan {

struct Context {
    std::unique_ptr<Instance> instance;
    VkPhysicalDevice physical = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    std::uint32_t queueFamily = 0;
    VkQueue queue = VK_NULL_HANDLE;
    DeviceInfo info;
    Allocator allocator;
    double timeoutSeconds = 0;
    bool countsWork = false;         ///< DeviceOptions::statistics, where the device has them
    std::atomic<bool> lost = false;  ///< may be noted by the thread that makes shaders

    Context() = default;
    ~Context();
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    /// Notes a lost device; every later call fails at once.
    tl::unexpected<Error> failed(VkResult result, const std::string& what);
    Status checkAlive() const;
};
using ContextPtr = std::shared_ptr<Context>;

/// Who touched a resource last, as far as later work has to wait for it.
struct AccessState {
    VkPipelineStageFlags2 writeStages = 0;
    VkAccessFlags2 writeAccess = 0;
    VkPipelineStageFlags2 readStages = 0;
    VkAccessFlags2 readAccess = 0;
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
};

class BufferImpl final : public Buffer {
  public:
    /// The description has been checked.
    static Result<std::shared_ptr<BufferImpl>> create(const ContextPtr& context, const BufferDesc& desc,
                                                      MemoryUse use);
    ~BufferImpl() override;

    VkBuffer handle = VK_NULL_HANDLE;
    VkBufferView view = VK_NULL_HANDLE;  ///< of typed buffers
    Allocation memory;
    AccessState state;

  private:
    BufferImpl(ContextPtr context, const BufferDesc& desc) : Buffer(desc), context_(std::move(context)) {}
    ContextPtr context_;
};

class TextureImpl final : public Texture {
  public:
    static Result<std::shared_ptr<TextureImpl>> create(const ContextPtr& context, const TextureDesc& desc);
    ~TextureImpl() override;
    VkImageAspectFlags aspect() const;

    VkImage handle = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
    Allocation memory;
    AccessState state;

  private:
    TextureImpl(ContextPtr context, const TextureDesc& desc) : Texture(desc), context_(std::move(context)) {}
    ContextPtr context_;
};

class SamplerImpl final : public Sampler {
  public:
    static Result<std::shared_ptr<SamplerImpl>> create(const ContextPtr& context, const SamplerDesc& desc);
    ~SamplerImpl() override;
    VkSampler handle = VK_NULL_HANDLE;

  private:
    explicit SamplerImpl(ContextPtr context) : context_(std::move(context)) {}
    ContextPtr context_;
};

class ShaderImpl final : public CheckedShader {
  public:
    static Result<std::shared_ptr<ShaderImpl>> create(const ContextPtr& context, const ShaderDesc& desc);
    ~ShaderImpl() override;
    VkShaderModule handle = VK_NULL_HANDLE;
    std::vector<ReflectedBinding> bindings;

  private:
    explicit ShaderImpl(ContextPtr context) : context_(std::move(context)) {}
    ContextPtr context_;
};

/// The part that graphics and compute pipelines share.
struct PipelineCore {
    explicit PipelineCore(ContextPtr c) : context(std::move(c)) {}
    ~PipelineCore();
    PipelineCore(const PipelineCore&) = delete;
    PipelineCore& operator=(const PipelineCore&) = delete;
    Status createLayout(std::span<const ShaderImpl* const> shaders);

    ContextPtr context;
    std::string name;
    VkPipelineBindPoint bindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
    VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    VkPipeline handle = VK_NULL_HANDLE;
    std::vector<ReflectedBinding> bindings;  ///< ascending
};

class GraphicsPipelineImpl final : public CheckedGraphicsPipeline {
  public:
    explicit GraphicsPipelineImpl(ContextPtr context) : core(std::move(context)) {}
    PipelineCore core;
};

class ComputePipelineImpl final : public CheckedComputePipeline {
  public:
    explicit ComputePipelineImpl(ContextPtr context) : core(std::move(context)) {}
    PipelineCore core;
};

Result<GraphicsPipelinePtr> createPipeline(const ContextPtr& context, const GraphicsPipelineDesc& desc);
Result<ComputePipelinePtr> createPipeline(const ContextPtr& context, const ComputePipelineDesc& desc);

VkFormat toVulkan(Format format);

}  // namespace hairloom::gpu::vulkan
