// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a command list must fulfil, on any backend: the order of calls, ranges, usages, what a pipeline's
// registers and targets need. A backend's list derives from CheckedList and is called with sound work only.

#include <map>
#include <utility>
#include <variant>

#include "core/gpu/device.h"
#include "core/gpu/register_use.h"

namespace hairloom::gpu {

/// A backend's pipelines derive from these.
class CheckedGraphicsPipeline : public GraphicsPipeline {
  public:
    const std::string& name() const final { return desc.name; }
    std::span<const ShaderRegister> registers() const final { return uses.registers(); }
    GraphicsPipelineDesc desc;
    RegisterUses uses;
};
class CheckedComputePipeline : public ComputePipeline {
  public:
    const std::string& name() const final { return desc.name; }
    std::span<const ShaderRegister> registers() const final { return uses.registers(); }
    ComputePipelineDesc desc;
    RegisterUses uses;
};

struct DirectDraw {
    std::uint32_t vertices, instances, firstVertex, firstInstance;
};
struct IndexedDraw {
    std::uint32_t indices, instances, firstIndex;
    std::int32_t vertexOffset;
    std::uint32_t firstInstance;
};
struct GroupCounts {
    std::uint32_t x, y, z;
};
/// A place in a buffer: of arguments, vertices or indices.
struct BufferPlace {
    BufferPtr buffer;
    std::uint64_t offset = 0;
};
using DrawArguments = std::variant<DirectDraw, IndexedDraw, BufferPlace>;
using DispatchArguments = std::variant<GroupCounts, BufferPlace>;

inline constexpr std::uint32_t kMaxPasses = 256;
inline constexpr std::size_t kMaxConstantBytes = 65536;

class CheckedList : public CommandList {
  public:
    void beginPass(const PassDesc& desc) final;
    void endPass() final;
    void setPipeline(const GraphicsPipelinePtr& pipeline) final;
    void setPipeline(const ComputePipelinePtr& pipeline) final;
    void bind(std::span<const Binding> bindings) final;
    void setConstants(std::uint32_t slot, std::span<const std::byte> bytes) final;
    void setVertexBuffer(const BufferPtr& buffer, std::uint64_t offset) final;
    void setIndexBuffer(const BufferPtr& buffer, std::uint64_t offset) final;
    void setViewport(const Viewport& viewport) final;
    void setScissor(const ScissorRect& scissor) final;
    void draw(std::uint32_t vertices, std::uint32_t instances, std::uint32_t firstVertex,
              std::uint32_t firstInstance) final;
    void drawIndexed(std::uint32_t indices, std::uint32_t instances, std::uint32_t firstIndex,
                     std::int32_t vertexOffset, std::uint32_t firstInstance) final;
    void drawIndirect(const BufferPtr& arguments, std::uint64_t offset) final;
    void dispatch(std::uint32_t x, std::uint32_t y, std::uint32_t z) final;
    void dispatchIndirect(const BufferPtr& arguments, std::uint64_t offset) final;
    void updateBuffer(const BufferPtr& target, std::uint64_t offset, std::span<const std::byte> bytes) final;
    void copyBuffer(const BufferPtr& source, std::uint64_t sourceOffset, const BufferPtr& target,
                    std::uint64_t targetOffset, std::uint64_t size) final;
    void copyTextureToBuffer(const TexturePtr& source, const BufferPtr& target,
                             std::uint64_t targetOffset) final;

    /// Of updates and constants.
    std::uint64_t uploadedBytes() const { return uploadedBytes_; }

  protected:
    enum class PassKind { None, Graphics, Compute };

    /// Keeps an object alive until the device has run the list.
    virtual void keep(std::shared_ptr<const void> object) = 0;
    virtual void recordPassBegin() = 0;  ///< passDesc(), passKind(), width() and height() are set
    virtual void recordPassEnd() = 0;
    /// Another pipeline or another binding from here on.
    virtual void bindingsChanged() = 0;
    /// A place of these bytes that can be bound as constants.
    virtual Result<Binding> stageConstants(std::uint32_t slot, std::span<const std::byte> bytes) = 0;
    /// With graphics(), vertices(), indices(), viewport() and scissor(); bound() covers the pipeline's
    /// registers.
    virtual void recordDraw(const DrawArguments& arguments) = 0;
    /// With compute(); bound() covers the pipeline's registers.
    virtual void recordDispatch(const DispatchArguments& arguments) = 0;
    virtual void recordUpdate(const BufferPtr& target, std::uint64_t offset,
                              std::span<const std::byte> bytes) = 0;
    virtual void recordCopy(const BufferPlace& source, const BufferPlace& target, std::uint64_t size) = 0;
    virtual void recordTextureCopy(const TexturePtr& source, const BufferPlace& target) = 0;

    /// The first wrong use is kept; from it on nothing is recorded.
    void wrong(const std::string& what);
    void wrong(const Error& error);
    /// The first wrong use, if any; an open pass is one.
    Status checkFinished();

    bool failed() const { return error_.has_value(); }
    PassKind passKind() const { return pass_; }
    const PassDesc& passDesc() const { return passDesc_; }
    std::uint32_t width() const { return width_; }
    std::uint32_t height() const { return height_; }
    const CheckedGraphicsPipeline& graphics() const { return *graphics_; }
    const CheckedComputePipeline& compute() const { return *compute_; }
    const BufferPlace& vertices() const { return vertices_; }
    const BufferPlace& indices() const { return indices_; }
    const Viewport& viewport() const { return viewport_; }
    const ScissorRect& scissor() const { return scissor_; }
    const Binding& bound(const ShaderRegister& at) const { return bound_.at(at); }
    /// Null where nothing is bound there; for registers that a shader declares and may not use.
    const Binding* boundIfAny(const ShaderRegister& at) const {
        const auto found = bound_.find(at);
        return found == bound_.end() ? nullptr : &found->second;
    }

  private:
    bool requirePass(PassKind kind, const char* call);
    bool requireOutside(const char* call);
    bool checkTargets(const PassDesc& desc);
    bool checkTarget(const Texture& texture, Usage usage, std::uint32_t& samples);
    bool targetsFit(const GraphicsPipelineDesc& desc) const;
    bool checkRegisters(const std::string& pipeline, const RegisterUses& uses);
    bool checkArguments(const BufferPtr& arguments, std::uint64_t offset, std::uint64_t size,
                        const char* call);
    void addDraw(const DrawArguments& arguments);
    void addDispatch(const DispatchArguments& arguments);

    std::optional<Error> error_;
    PassKind pass_ = PassKind::None;
    PassDesc passDesc_;
    std::uint32_t passCount_ = 0;
    std::uint32_t width_ = 0, height_ = 0;
    std::shared_ptr<const CheckedGraphicsPipeline> graphics_;
    std::shared_ptr<const CheckedComputePipeline> compute_;
    BufferPlace vertices_, indices_;
    Viewport viewport_;
    ScissorRect scissor_;
    std::map<ShaderRegister, Binding> bound_;
    std::uint64_t uploadedBytes_ = 0;
};

}  // namespace hairloom::gpu
