// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Recording. A graphics pass is kept as a list of draws until it ends: only then is known which barriers have
// to stand before it, and none may stand inside.

#include "core/gpu/vulkan/barriers.h"

namespace hairloom::gpu::vulkan {

/// What PassCounts has.
inline constexpr VkQueryPipelineStatisticFlags kStatistics =
    VK_QUERY_PIPELINE_STATISTIC_INPUT_ASSEMBLY_VERTICES_BIT |
    VK_QUERY_PIPELINE_STATISTIC_VERTEX_SHADER_INVOCATIONS_BIT |
    VK_QUERY_PIPELINE_STATISTIC_CLIPPING_INVOCATIONS_BIT |
    VK_QUERY_PIPELINE_STATISTIC_FRAGMENT_SHADER_INVOCATIONS_BIT |
    VK_QUERY_PIPELINE_STATISTIC_TESSELLATION_CONTROL_SHADER_PATCHES_BIT |
    VK_QUERY_PIPELINE_STATISTIC_TESSELLATION_EVALUATION_SHADER_INVOCATIONS_BIT;
inline constexpr std::size_t kStatisticsCount = 6;

/// What one list owns until the device has run it.
struct Recording {
    /// Errors: out of memory.
    static Result<std::unique_ptr<Recording>> create(const ContextPtr& context);
    ~Recording();
    Recording(const Recording&) = delete;
    Recording& operator=(const Recording&) = delete;

    /// Forgets what was recorded and keeps the pools; the device has run it.
    Status reset();

    ContextPtr context;
    VkFence fence = VK_NULL_HANDLE;  ///< of the submission that ends with it
    VkCommandPool pool = VK_NULL_HANDLE;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    VkQueryPool queries = VK_NULL_HANDLE;
    VkQueryPool statistics = VK_NULL_HANDLE;  ///< where DeviceOptions asked for it: one a graphics pass
    std::vector<VkDescriptorPool> descriptorPools;
    std::size_t descriptorPoolsUsed = 0;
    std::shared_ptr<BufferImpl> arena;  ///< the first upload memory
    std::vector<std::shared_ptr<const void>> retained;
    struct Pass {
        std::string name;
        bool counted = false;  ///< it has a query of statistics
    };
    std::vector<Pass> passes;  ///< pass i has the queries 2i and 2i + 1, and i of statistics

  private:
    explicit Recording(ContextPtr c) : context(std::move(c)) {}
};

/// Recordings that the device has run, to be used again: making pools takes longer than recording a short
/// list.
class RecordingStore {
  public:
    explicit RecordingStore(ContextPtr context) : context_(std::move(context)) {}
    /// One without content.
    Result<std::unique_ptr<Recording>> take();
    /// One that the device has run.
    void giveBack(std::unique_ptr<Recording> recording);

  private:
    ContextPtr context_;
    std::vector<std::unique_ptr<Recording>> idle_;
};

struct DrawCall {
    VkDescriptorSet set = VK_NULL_HANDLE;
    const GraphicsPipelineImpl* pipeline = nullptr;
    VkBuffer vertexBuffer = VK_NULL_HANDLE;
    std::uint64_t vertexOffset = 0;
    VkBuffer indexBuffer = VK_NULL_HANDLE;
    std::uint64_t indexOffset = 0;
    VkViewport viewport{};
    VkRect2D scissor{};
    DrawArguments arguments;
};

class CommandListImpl final : public CheckedList {
  public:
    /// `onClose` runs when the list is destroyed.
    static Result<std::unique_ptr<CommandListImpl>> create(RecordingStore& store,
                                                           std::function<void()> onClose);
    ~CommandListImpl() override;

    /// For the first content of a texture.
    void updateTexture(const TexturePtr& target, std::span<const std::byte> bytes);
    /// Ends recording; the first wrong use comes back here.
    Result<std::unique_ptr<Recording>> finish();
    /// The resources' states become those after this list. After a successful submission.
    void commit() { barriers_.commit(); }
    std::uint64_t stagedBytes() const { return stagedBytes_; }

  private:
    struct Staged {
        std::shared_ptr<BufferImpl> buffer;
        std::uint64_t offset = 0;
    };

    CommandListImpl(std::unique_ptr<Recording> recording, std::function<void()> onClose);
    void keep(std::shared_ptr<const void> object) override {
        recording_->retained.push_back(std::move(object));
    }
    void recordPassBegin() override;
    void recordPassEnd() override;
    void bindingsChanged() override { set_ = VK_NULL_HANDLE; }
    Result<Binding> stageConstants(std::uint32_t slot, std::span<const std::byte> bytes) override;
    void recordDraw(const DrawArguments& arguments) override;
    void recordDispatch(const DispatchArguments& arguments) override;
    void recordUpdate(const BufferPtr& target, std::uint64_t offset,
                      std::span<const std::byte> bytes) override;
    void recordCopy(const BufferPlace& source, const BufferPlace& target, std::uint64_t size) override;
    void recordTextureCopy(const TexturePtr& source, const BufferPlace& target) override;

    /// Copies bytes into upload memory at a multiple of 256.
    Result<Staged> stage(std::span<const std::byte> bytes);
    void writeTimestamp(bool end);
    void beginStatistics();
    void endStatistics();

    // bindings.cpp
    VkDescriptorSet makeSet(const PipelineCore& pipeline, VkPipelineStageFlags2 stages);
    Result<VkDescriptorSet> allocateSet(VkDescriptorSetLayout layout);
    void useBinding(const Binding& binding, const ReflectedBinding& wanted, VkPipelineStageFlags2 stages);

    // passes.cpp
    void useTargets();
    void usePlace(const BufferPlace& place, VkPipelineStageFlags2 stage, VkAccessFlags2 access);
    void beginRendering();
    void replay(const DrawCall& call);

    std::unique_ptr<Recording> recording_;
    std::function<void()> onClose_;
    BarrierTracker barriers_;
    std::vector<DrawCall> draws_;
    VkDescriptorSet set_ = VK_NULL_HANDLE;  // valid while nothing was bound since

    Staged arena_;
    std::uint64_t arenaUsed_ = 0;
    std::uint64_t stagedBytes_ = 0;
    std::uint32_t setsLeft_ = 0;
};

}  // namespace hairloom::gpu::vulkan
