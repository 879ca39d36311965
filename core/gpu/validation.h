// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A device around any device that watches its user: it refuses what the interface forbids but a driver may
// let pass, keeps a record of what ran and of what exists, and can make the device fail on purpose.
//
// Refused, besides what every backend refuses, with the pass and the resource in the message:
// - one draw or dispatch, or the pass around it, that reads a resource and writes it too;
// - reading what nothing has written (a shader, a copy, a target that is loaded, indirect arguments);
// - indices, vertices or indirect arguments beyond their buffer;
// - reading a read-back buffer on the CPU while the submission that fills it may still run.

#include <atomic>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "core/gpu/device.h"

namespace hairloom::gpu {

/// One thing that the device was asked to do.
struct RecordedWork {
    enum class Kind { Draw, Dispatch, Update, Copy };
    Kind kind = Kind::Draw;
    std::string pass;      ///< empty outside passes
    std::string pipeline;  ///< of draws and dispatches
    /// Names of what its shaders, its targets or the copy use. Content given to setConstants() has none.
    std::vector<std::string> reads, writes;
};

/// A buffer or texture that is held by someone.
struct LivingResource {
    std::string name;
    std::uint64_t bytes = 0;  ///< of its content; drivers may take more
};

/// What is known about content; shared between the device and its open list.
struct ContentState {
    bool written = false;
    std::weak_ptr<Submission> filledBy;  ///< of read-back buffers
};
using ContentStates =
    std::map<std::weak_ptr<const void>, ContentState, std::owner_less<std::weak_ptr<const void>>>;

class ValidationDevice final : public Device {
  public:
    explicit ValidationDevice(std::unique_ptr<Device> inner) : inner_(std::move(inner)) {}

    /// Work of submitted lists since the last clearRecord(), in order.
    const std::vector<RecordedWork>& record() const { return record_; }
    void clearRecord() { record_.clear(); }
    std::vector<LivingResource> living();
    /// The creation (of anything) after `calls` more successful ones fails as if memory had run out, once.
    void failCreation(std::uint64_t calls);
    /// The submission after `calls` more fails as a lost device does, and so does everything after it.
    void loseDevice(std::uint64_t calls) { submissionsLeft_ = calls; }

    const DeviceInfo& info() const override { return inner_->info(); }
    Traffic traffic() const override { return inner_->traffic(); }
    Result<BufferPtr> createBuffer(const BufferDesc& desc, std::span<const std::byte> content) override;
    Result<TexturePtr> createTexture(const TextureDesc& desc, std::span<const std::byte> content) override;
    Result<SamplerPtr> createSampler(const SamplerDesc& desc) override;
    Result<ShaderPtr> createShader(const ShaderDesc& desc) override;
    Result<GraphicsPipelinePtr> createGraphicsPipeline(const GraphicsPipelineDesc& desc) override;
    Result<ComputePipelinePtr> createComputePipeline(const ComputePipelineDesc& desc) override;
    Result<std::unique_ptr<SwapChain>> createSwapChain(const SwapChainDesc& desc) override;
    Result<std::unique_ptr<CommandList>> createCommandList() override;
    Result<SubmissionPtr> submit(std::unique_ptr<CommandList> list) override;
    Status readMapped(const BufferPtr& buffer, std::uint64_t offset, std::span<std::byte> target) override;
    Status readBuffer(const BufferPtr& buffer, std::uint64_t offset, std::span<std::byte> target) override;
    Status readTexture(const TexturePtr& texture, std::span<std::byte> target) override;
    std::vector<std::string> validationMessages() const override { return inner_->validationMessages(); }

  private:
    Status beforeCreation(const std::string& what);
    Status checkAlive() const;
    Status requireContent(const std::shared_ptr<const void>& resource, const std::string& what) const;
    void track(const std::shared_ptr<const void>& resource, LivingResource described, bool written);

    struct Tracked {
        std::weak_ptr<const void> resource;
        LivingResource described;
    };

    std::unique_ptr<Device> inner_;
    std::vector<RecordedWork> record_;
    std::vector<Tracked> tracked_;
    ContentStates contents_;
    std::map<std::weak_ptr<const void>, GraphicsPipelineDesc, std::owner_less<std::weak_ptr<const void>>>
        pipelines_;
    std::optional<std::uint64_t> submissionsLeft_;
    // Shaders and compute pipelines may be made on another thread.
    std::mutex creationsMutex_;
    std::optional<std::uint64_t> creationsLeft_;
    std::atomic<bool> lost_ = false;
};

/// The wrapper that createDevice() put around the device where validation was asked for; else nullptr.
ValidationDevice* validationOf(Device& device);

}  // namespace hairloom::gpu
