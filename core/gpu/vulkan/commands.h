// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Recording. A graphics pass is kept as a list of draws until it ends: only then is known which barriers have
// to stand before it, and none may stand inside.

#include <map>
#include <variant>

#include "core/gpu/vulkan/barriers.h"

namespace hairloom::gpu::vulkan {

/// What one list owns until the device has run it.
struct Recording {
    explicit Recording(ContextPtr c) : context(std::move(c)) {}
    ~Recording();
    Recording(const Recording&) = delete;
    Recording& operator=(const Recording&) = delete;

    ContextPtr context;
    VkCommandPool pool = VK_NULL_HANDLE;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    VkQueryPool queries = VK_NULL_HANDLE;
    std::vector<VkDescriptorPool> descriptorPools;
    std::vector<std::shared_ptr<const void>> retained;
    std::vector<std::string> passNames;  ///< pass i has the queries 2i and 2i + 1
};

inline constexpr std::uint32_t kMaxPasses = 256;

struct DrawCall {
    VkDescriptorSet set = VK_NULL_HANDLE;
    const GraphicsPipelineImpl* pipeline = nullptr;
    VkBuffer vertexBuffer = VK_NULL_HANDLE;
    std::uint64_t vertexOffset = 0;
    VkBuffer indexBuffer = VK_NULL_HANDLE;
    std::uint64_t indexOffset = 0;
    VkViewport viewport{};
    VkRect2D scissor{};
    struct Direct {
        std::uint32_t vertices, instances, firstVertex, firstInstance;
    };
    struct Indexed {
        std::uint32_t indices, instances, firstIndex;
        std::int32_t vertexOffset;
        std::uint32_t firstInstance;
    };
    struct Indirect {
        VkBuffer buffer;
        std::uint64_t offset;
    };
    std::variant<Direct, Indexed, Indirect> arguments;
};

class CommandListImpl final : public CommandList {
  public:
    /// `onClose` runs when the list is destroyed.
    static Result<std::unique_ptr<CommandListImpl>> create(const ContextPtr& context,
                                                           std::function<void()> onClose);
    ~CommandListImpl() override;

    void beginPass(const PassDesc& desc) override;
    void endPass() override;
    void setPipeline(const GraphicsPipelinePtr& pipeline) override;
    void setPipeline(const ComputePipelinePtr& pipeline) override;
    void bind(std::span<const Binding> bindings) override;
    void setConstants(std::uint32_t slot, std::span<const std::byte> bytes) override;
    void setVertexBuffer(const BufferPtr& buffer, std::uint64_t offset) override;
    void setIndexBuffer(const BufferPtr& buffer, std::uint64_t offset) override;
    void setViewport(const Viewport& viewport) override;
    void setScissor(const ScissorRect& scissor) override;
    void draw(std::uint32_t vertices, std::uint32_t instances, std::uint32_t firstVertex,
              std::uint32_t firstInstance) override;
    void drawIndexed(std::uint32_t indices, std::uint32_t instances, std::uint32_t firstIndex,
                     std::int32_t vertexOffset, std::uint32_t firstInstance) override;
    void drawIndirect(const BufferPtr& arguments, std::uint64_t offset) override;
    void dispatch(std::uint32_t x, std::uint32_t y, std::uint32_t z) override;
    void dispatchIndirect(const BufferPtr& arguments, std::uint64_t offset) override;
    void updateBuffer(const BufferPtr& target, std::uint64_t offset,
                      std::span<const std::byte> bytes) override;
    void copyBuffer(const BufferPtr& source, std::uint64_t sourceOffset, const BufferPtr& target,
                    std::uint64_t targetOffset, std::uint64_t size) override;
    void copyTextureToBuffer(const TexturePtr& source, const BufferPtr& target,
                             std::uint64_t targetOffset) override;

    /// For the first content of a texture.
    void updateTexture(const TexturePtr& target, std::span<const std::byte> bytes);
    /// Ends recording; the first wrong use comes back here.
    Result<std::unique_ptr<Recording>> finish();
    /// The resources' states become those after this list. After a successful submission.
    void commit() { barriers_.commit(); }
    std::uint64_t stagedBytes() const { return stagedBytes_; }

  private:
    enum class PassKind { None, Graphics, Compute };
    struct Staged {
        std::shared_ptr<BufferImpl> buffer;
        std::uint64_t offset = 0;
    };

    CommandListImpl(std::unique_ptr<Recording> recording, std::function<void()> onClose);
    void wrong(const std::string& what);
    void wrong(const Error& error);
    bool requirePass(PassKind kind, const char* call);
    bool requireOutside(const char* call);
    void keep(std::shared_ptr<const void> object) { recording_->retained.push_back(std::move(object)); }
    BufferImpl* keep(const BufferPtr& buffer);
    TextureImpl* keep(const TexturePtr& texture);

    /// Copies bytes into upload memory at a multiple of 256.
    Result<Staged> stage(std::span<const std::byte> bytes);
    void writeTimestamp(bool end);

    // bindings.cpp
    VkDescriptorSet makeSet(const PipelineCore& pipeline, VkPipelineStageFlags2 stages);
    Result<VkDescriptorSet> allocateSet(VkDescriptorSetLayout layout);
    bool useBinding(const Binding& binding, const ReflectedBinding& wanted, VkPipelineStageFlags2 stages,
                    const std::string& where);

    // passes.cpp
    bool checkTargets(const PassDesc& desc, std::uint32_t& width, std::uint32_t& height);
    void useTargets();
    void beginRendering();
    void replay(const DrawCall& call);
    void addDraw(DrawCall call);
    bool prepareDispatch();

    std::unique_ptr<Recording> recording_;
    std::function<void()> onClose_;
    BarrierTracker barriers_;
    std::optional<Error> error_;

    PassKind pass_ = PassKind::None;
    PassDesc passDesc_;
    std::uint32_t width_ = 0, height_ = 0;
    std::vector<DrawCall> draws_;
    DrawCall current_;
    std::shared_ptr<const GraphicsPipelineImpl> graphics_;
    std::shared_ptr<const ComputePipelineImpl> compute_;
    std::map<std::uint32_t, Binding> bound_;  // by binding number
    VkDescriptorSet set_ = VK_NULL_HANDLE;    // valid while nothing was bound since

    Staged arena_;
    std::uint64_t arenaUsed_ = 0;
    std::uint64_t stagedBytes_ = 0;
    std::uint32_t setsLeft_ = 0;
};

}  // namespace hairloom::gpu::vulkan
