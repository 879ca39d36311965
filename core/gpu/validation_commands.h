// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The validation device's command list: forwards every call until one is wrong, and notes that one.

#include <functional>
#include <map>

#include "core/gpu/validation.h"

namespace hairloom::gpu {

class ValidationCommandList final : public CommandList {
  public:
    using PipelineOf = std::function<const GraphicsPipelineDesc*(const GraphicsPipelinePtr&)>;

    /// `contents` is what submitted lists have left; it must outlive the list.
    ValidationCommandList(std::unique_ptr<CommandList> inner, const ContentStates& contents,
                          PipelineOf pipelineOf)
        : inner_(std::move(inner)), contents_(contents), pipelineOf_(std::move(pipelineOf)) {}

    void beginPass(const PassDesc& desc) override;
    void endPass() override;
    void setPipeline(const GraphicsPipelinePtr& pipeline) override;
    void setPipeline(const ComputePipelinePtr& pipeline) override;
    void bind(std::span<const Binding> bindings) override;
    void setConstants(std::uint32_t slot, std::span<const std::byte> bytes) override;
    void setVertexBuffer(const BufferPtr& buffer, std::uint64_t offset) override;
    void setIndexBuffer(const BufferPtr& buffer, std::uint64_t offset) override;
    void setViewport(const Viewport& viewport) override { inner_->setViewport(viewport); }
    void setScissor(const ScissorRect& scissor) override { inner_->setScissor(scissor); }
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

    const std::optional<Error>& error() const { return error_; }
    std::unique_ptr<CommandList> takeInner() { return std::move(inner_); }
    std::vector<RecordedWork> takeRecord() { return std::move(record_); }
    /// Notes what this list has written; read-back buffers are filled by the submission.
    void commit(ContentStates& contents, const SubmissionPtr& submission) const;

  private:
    /// A resource that the work at hand uses, with the name that it goes by.
    struct Used {
        std::shared_ptr<const void> resource;
        std::string name;
        bool write = false;
    };

    void wrong(const std::string& what);
    bool hasContent(const std::shared_ptr<const void>& resource) const;
    void use(RecordedWork& work, const Used& used);
    void gatherRegisters(std::vector<Used>& used, const Pipeline& pipeline) const;
    std::vector<Used> targets() const;
    /// Checks one draw or dispatch and puts it into the record.
    void run(RecordedWork::Kind kind, const Pipeline* pipeline, const BufferPtr& arguments);
    void noteCopy(const Used& source, const BufferPtr& target);
    void checkVertices(std::uint64_t lastVertex);

    std::unique_ptr<CommandList> inner_;
    const ContentStates& contents_;
    PipelineOf pipelineOf_;
    std::vector<std::shared_ptr<const void>> written_;
    std::vector<std::shared_ptr<const void>> filled_;  ///< buffers that copies have written
    std::vector<RecordedWork> record_;
    std::optional<Error> error_;

    PassDesc pass_;
    GraphicsPipelinePtr graphics_;
    ComputePipelinePtr compute_;
    std::map<ShaderRegister, Binding> bound_;
    BufferPtr vertices_, indices_;
    std::uint64_t vertexOffset_ = 0, indexOffset_ = 0;
};

}  // namespace hairloom::gpu
