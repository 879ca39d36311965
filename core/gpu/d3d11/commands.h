// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Recording. Direct3D's immediate context acts at once, and its deferred contexts cannot ask for timestamps
// that are flushed, so a list keeps its work as steps that submitting takes.

#include <functional>

#include "core/gpu/d3d11/resources.h"

namespace hairloom::gpu::d3d11 {

/// A texture's rows on their way into a read-back buffer: the CPU moves them once the device is done.
struct RowCopy {
    ComPtr<ID3D11Texture2D> staging;
    std::shared_ptr<const TextureImpl> source;
    std::shared_ptr<BufferImpl> target;
    std::uint64_t offset = 0;
};

/// The two timestamps of a pass, and what its stages did, where that was asked for.
struct PassQueries {
    std::string name;
    ComPtr<ID3D11Query> begin, end, statistics;
};

/// What one list holds until the device has run it.
struct Recording {
    using Step = std::function<void(ID3D11DeviceContext&)>;
    std::vector<Step> steps;
    std::vector<std::shared_ptr<const void>> retained;
    std::vector<PassQueries> passes;
    std::vector<RowCopy> rowCopies;
    bool fillsReadBack = false;
};

/// The views of one stage's registers.
struct StageViews {
    ShaderStage stage = ShaderStage::Vertex;
    std::vector<std::pair<UINT, ID3D11Buffer*>> constants;
    std::vector<std::pair<UINT, ID3D11ShaderResourceView*>> reads;
    std::vector<std::pair<UINT, ID3D11SamplerState*>> samplers;
    std::vector<std::pair<UINT, ID3D11UnorderedAccessView*>> writes;
};

class CommandListImpl final : public CheckedList {
  public:
    /// `onClose` runs when the list is destroyed.
    CommandListImpl(ContextPtr context, std::function<void()> onClose)
        : context_(std::move(context)), onClose_(std::move(onClose)) {}
    CommandListImpl(const CommandListImpl&) = delete;
    CommandListImpl& operator=(const CommandListImpl&) = delete;
    ~CommandListImpl() override;

    /// Ends recording; the first wrong use comes back here.
    Result<Recording> finish();

  private:
    void keep(std::shared_ptr<const void> object) override {
        recording_.retained.push_back(std::move(object));
    }
    void recordPassBegin() override;
    void recordPassEnd() override;
    void bindingsChanged() override { views_.reset(); }
    Result<Binding> stageConstants(std::uint32_t slot, std::span<const std::byte> bytes) override;
    void recordDraw(const DrawArguments& arguments) override;
    void recordDispatch(const DispatchArguments& arguments) override;
    void recordUpdate(const BufferPtr& target, std::uint64_t offset,
                      std::span<const std::byte> bytes) override;
    void recordCopy(const BufferPlace& source, const BufferPlace& target, std::uint64_t size) override;
    void recordTextureCopy(const TexturePtr& source, const BufferPlace& target) override;

    void step(Recording::Step work) { recording_.steps.push_back(std::move(work)); }
    void setTimestamp(ComPtr<ID3D11Query>& query);
    void beginStatistics(ComPtr<ID3D11Query>& query);
    void setTargets();
    // bindings.cpp
    bool collectViews(std::span<const std::shared_ptr<const ShaderImpl>> shaders);
    bool addView(StageViews& views, const RegisterUse& use);
    Result<ID3D11Buffer*> constantBuffer(const Binding& binding);

    ContextPtr context_;
    std::function<void()> onClose_;
    Recording recording_;
    std::shared_ptr<const std::vector<StageViews>> views_;  ///< as long as nothing was bound since
};

/// Binds the views for their stages.
void setViews(ID3D11DeviceContext& context, std::span<const StageViews> stages);
/// Takes away what setViews() bound, so that the next use of a resource meets no old one.
void clearViews(ID3D11DeviceContext& context, std::span<const StageViews> stages);

}  // namespace hairloom::gpu::d3d11
