// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Commands that are done as they are recorded.

#include <deque>

#include "core/gpu/checked_list.h"
#include "core/software/kernel.h"
#include "core/software/lazy_shading.h"
#include "core/software/light_maps.h"
#include "core/software/sorted_hair.h"
#include "core/software/stop.h"

namespace hairloom::software {

class HostShader : public gpu::CheckedShader {
  public:
    const KernelEntry* kernel = nullptr;  ///< null for one whose pipeline has a form of its own
};

class HostComputePipeline : public gpu::CheckedComputePipeline {
  public:
    const KernelEntry* kernel = nullptr;
    std::vector<gpu::ShaderRegister> declared;
};

/// Hair of a frame between its fragments and its light.
struct HairOfFrame {
    std::unique_ptr<SortedHair> sorted;
    gpu::BufferPtr nearest, cover;
    std::vector<gpu::BufferPtr> curves;   ///< that it reads
    std::vector<gpu::BufferPtr> colours;  ///< of its batches, as their light is asked for
    std::vector<gpu::BufferPtr> across;   ///< and what of it changes over their width
};

/// What a device keeps between commands.
struct HostState {
    explicit HostState(Stop asked) : stop(std::move(asked)), maps(stop) {}

    Stop stop;
    HairOfFrame hair;
    LightMaps maps;
};

/// What a graphics pipeline does.
enum class HostDraw {
    meshDepth,   ///< least depths of triangles
    fullscreen,  ///< a pixel shader over the whole target
    marks,       ///< points, lines and triangles over a picture
};
class HostGraphicsPipeline : public gpu::CheckedGraphicsPipeline {
  public:
    HostDraw draw = HostDraw::fullscreen;
    const KernelEntry* kernel = nullptr;  ///< of HostDraw::fullscreen, with what it declares
    std::vector<gpu::ShaderRegister> declared;
};

class HostSubmission : public gpu::Submission {
  public:
    explicit HostSubmission(std::vector<gpu::PassTime> times) : times_(std::move(times)) {}
    bool isDone() override { return true; }
    Status wait() override { return {}; }
    Result<std::vector<gpu::PassTime>> passTimes() override { return times_; }

  private:
    std::vector<gpu::PassTime> times_;
};

class HostCommandList : public gpu::CheckedList {
  public:
    /// `state` outlives it.
    HostCommandList(HostState& state, std::function<void()> whenClosed)
        : hair_(state.hair), maps_(state.maps), stop_(state.stop), whenClosed_(std::move(whenClosed)) {
        // What a list that was left has begun.
        hair_ = {};
        maps_.forget();
    }
    ~HostCommandList() override;
    HostCommandList(const HostCommandList&) = delete;
    HostCommandList& operator=(const HostCommandList&) = delete;

    Result<gpu::SubmissionPtr> finish();

  protected:
    void keep(std::shared_ptr<const void> object) override;
    void recordPassBegin() override;
    void recordPassEnd() override;
    void bindingsChanged() override {}
    Result<gpu::Binding> stageConstants(std::uint32_t slot, std::span<const std::byte> bytes) override;
    void recordDraw(const gpu::DrawArguments& arguments) override;
    void recordDispatch(const gpu::DispatchArguments& arguments) override;
    void recordUpdate(const gpu::BufferPtr& target, std::uint64_t offset,
                      std::span<const std::byte> bytes) override;
    void recordCopy(const gpu::BufferPlace& source, const gpu::BufferPlace& target,
                    std::uint64_t size) override;
    void recordTextureCopy(const gpu::TexturePtr& source, const gpu::BufferPlace& target) override;

  private:
    /// `settles`: what is put off of the buffers that are read is done first.
    Registers registersOf(std::span<const gpu::ShaderRegister> used, bool settles) const;
    void drawMeshDepth(std::uint32_t vertices);
    void drawFullscreen(const KernelEntry& kernel);
    void drawMarks(std::uint32_t vertices);
    /// Nobody waits for it: nothing is recorded from here on.
    bool leaves();
    void close();
    const gpu::BufferPtr& read(std::uint32_t slot) const;
    const gpu::BufferPtr& written(std::uint32_t slot) const;
    template <class T>
    const T& constantsAt(std::uint32_t slot) const;
    RibbonBatch batchOf() const;
    /// True where the dispatch has a form of its own, and is done.
    bool dispatchApart(const KernelEntry& kernel);
    void dispatchSorted();
    void resolveSorted();
    bool deferShading(const KernelEntry& kernel);
    bool deferSky(const KernelEntry& kernel);
    DeferredDispatch deferred(const KernelEntry& kernel) const;

    HairOfFrame& hair_;
    LightMaps& maps_;
    const Stop& stop_;
    std::function<void()> whenClosed_;
    std::vector<gpu::PassTime> times_;
    double passBegan_ = 0;  ///< seconds
};

}  // namespace hairloom::software
