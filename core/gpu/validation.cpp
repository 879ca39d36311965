// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/gpu/validation.h"

#include <algorithm>
#include <utility>

#include "core/gpu/validation_commands.h"

namespace hairloom::gpu {

ValidationDevice* validationOf(Device& device) {
    return dynamic_cast<ValidationDevice*>(&device);
}

Status ValidationDevice::checkAlive() const {
    if (lost_) return fail("GPU '" + info().name + "' is lost", "a new device");
    return {};
}

Status ValidationDevice::beforeCreation(const std::string& what) {
    if (auto status = checkAlive(); !status) return status;
    const std::lock_guard lock(creationsMutex_);
    if (!creationsLeft_) return {};
    if (*creationsLeft_ > 0) {
        --*creationsLeft_;
        return {};
    }
    creationsLeft_.reset();
    return fail("creating " + what + ": out of device memory",
                "expected a device with more memory, less hair, or the CPU");
}

void ValidationDevice::failCreation(std::uint64_t calls) {
    const std::lock_guard lock(creationsMutex_);
    creationsLeft_ = calls;
}

void ValidationDevice::track(const std::shared_ptr<const void>& resource, LivingResource described,
                             bool written) {
    tracked_.push_back({resource, std::move(described)});
    contents_[resource] = {written, {}};
}

std::vector<LivingResource> ValidationDevice::living() {
    std::erase_if(tracked_, [](const Tracked& t) { return t.resource.expired(); });
    std::erase_if(contents_, [](const auto& entry) { return entry.first.expired(); });
    std::erase_if(pipelines_, [](const auto& entry) { return entry.first.expired(); });
    std::vector<LivingResource> result;
    for (const Tracked& t : tracked_) result.push_back(t.described);
    return result;
}

Result<BufferPtr> ValidationDevice::createBuffer(const BufferDesc& desc, std::span<const std::byte> content) {
    if (auto status = beforeCreation("buffer '" + desc.name + "'"); !status)
        return tl::unexpected(status.error());
    auto buffer = inner_->createBuffer(desc, content);
    if (buffer) track(*buffer, {desc.name, desc.size}, !content.empty());
    return buffer;
}

Result<TexturePtr> ValidationDevice::createTexture(const TextureDesc& desc,
                                                   std::span<const std::byte> content) {
    if (auto status = beforeCreation("texture '" + desc.name + "'"); !status)
        return tl::unexpected(status.error());
    auto texture = inner_->createTexture(desc, content);
    if (texture) {
        const std::uint64_t texels = std::uint64_t{desc.width} * desc.height * desc.samples;
        track(*texture, {desc.name, texels * bytesPerTexel(desc.format)}, !content.empty());
    }
    return texture;
}

Result<SamplerPtr> ValidationDevice::createSampler(const SamplerDesc& desc) {
    if (auto status = beforeCreation("a sampler"); !status) return tl::unexpected(status.error());
    return inner_->createSampler(desc);
}

Result<ShaderPtr> ValidationDevice::createShader(const ShaderDesc& desc) {
    if (auto status = beforeCreation("shader '" + desc.name + "'"); !status)
        return tl::unexpected(status.error());
    return inner_->createShader(desc);
}

Result<GraphicsPipelinePtr> ValidationDevice::createGraphicsPipeline(const GraphicsPipelineDesc& desc) {
    if (auto status = beforeCreation("pipeline '" + desc.name + "'"); !status)
        return tl::unexpected(status.error());
    auto pipeline = inner_->createGraphicsPipeline(desc);
    if (pipeline) pipelines_[*pipeline] = desc;
    return pipeline;
}

Result<ComputePipelinePtr> ValidationDevice::createComputePipeline(const ComputePipelineDesc& desc) {
    if (auto status = beforeCreation("pipeline '" + desc.name + "'"); !status)
        return tl::unexpected(status.error());
    return inner_->createComputePipeline(desc);
}

Result<std::unique_ptr<SwapChain>> ValidationDevice::createSwapChain(const SwapChainDesc& desc) {
    if (auto status = beforeCreation("a swap chain"); !status) return tl::unexpected(status.error());
    return inner_->createSwapChain(desc);
}

Result<std::unique_ptr<CommandList>> ValidationDevice::createCommandList() {
    if (auto status = checkAlive(); !status) return tl::unexpected(status.error());
    auto inner = inner_->createCommandList();
    if (!inner) return inner;
    const auto pipelineOf = [this](const GraphicsPipelinePtr& pipeline) -> const GraphicsPipelineDesc* {
        const auto found = pipelines_.find(pipeline);
        return found == pipelines_.end() ? nullptr : &found->second;
    };
    return std::make_unique<ValidationCommandList>(std::move(*inner), contents_, pipelineOf);
}

Result<SubmissionPtr> ValidationDevice::submit(std::unique_ptr<CommandList> list) {
    if (auto status = checkAlive(); !status) return tl::unexpected(status.error());
    auto* checked = dynamic_cast<ValidationCommandList*>(list.get());
    if (checked == nullptr) return fail("no command list of this device to submit");
    if (submissionsLeft_ && (*submissionsLeft_)-- == 0) {
        lost_ = true;
        return fail("submitting work: the device is lost",
                    "expected a device that finishes its work: try again, another device, or the CPU");
    }
    if (checked->error()) return tl::unexpected(*checked->error());
    auto submission = inner_->submit(checked->takeInner());
    if (!submission) return submission;
    checked->commit(contents_, *submission);
    std::ranges::move(checked->takeRecord(), std::back_inserter(record_));
    return submission;
}

Status ValidationDevice::requireContent(const std::shared_ptr<const void>& resource,
                                        const std::string& what) const {
    const auto known = contents_.find(resource);
    if (known != contents_.end() && !known->second.written)
        return fail("reading " + what + ", which nothing has written");
    return {};
}

Status ValidationDevice::readMapped(const BufferPtr& buffer, std::uint64_t offset,
                                    std::span<std::byte> target) {
    if (auto status = checkAlive(); !status) return status;
    if (buffer != nullptr) {
        const std::string what = "buffer '" + buffer->desc().name + "'";
        if (auto status = requireContent(buffer, what); !status) return status;
        const auto filling = contents_.find(buffer);
        const auto submission = filling == contents_.end() ? nullptr : filling->second.filledBy.lock();
        if (submission && !submission->isDone())
            return fail("reading " + what + ", whose copy may still run", "a wait for its submission");
    }
    return inner_->readMapped(buffer, offset, target);
}

Status ValidationDevice::readBuffer(const BufferPtr& buffer, std::uint64_t offset,
                                    std::span<std::byte> target) {
    if (auto status = checkAlive(); !status) return status;
    if (buffer != nullptr && !target.empty()) {
        const std::string what = "buffer '" + buffer->desc().name + "'";
        if (auto status = requireContent(buffer, what); !status) return status;
    }
    return inner_->readBuffer(buffer, offset, target);
}

Status ValidationDevice::readTexture(const TexturePtr& texture, std::span<std::byte> target) {
    if (auto status = checkAlive(); !status) return status;
    if (texture != nullptr) {
        const std::string what = "texture '" + texture->desc().name + "'";
        if (auto status = requireContent(texture, what); !status) return status;
    }
    return inner_->readTexture(texture, target);
}

}  // namespace hairloom::gpu
