// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/gpu/vulkan/commands.h"

#include <algorithm>
#include <cstring>

namespace hairloom::gpu::vulkan {
namespace {

constexpr std::uint64_t kArenaBytes = 1u << 20u;
constexpr std::uint64_t kArenaAlignment = 256;
constexpr Use kCopyRead{VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT,
                        VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, false, false};
constexpr Use kCopyWrite{VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                         VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, true, false};

BufferImpl& impl(const BufferPlace& place) {
    return static_cast<BufferImpl&>(*place.buffer);
}

VkBufferImageCopy wholeImage(const TextureImpl& texture, std::uint64_t bufferOffset) {
    VkBufferImageCopy copy{};
    copy.bufferOffset = bufferOffset;
    copy.imageSubresource = {texture.aspect(), 0, 0, 1};
    copy.imageExtent = {texture.desc().width, texture.desc().height, 1};
    return copy;
}

}  // namespace

Recording::~Recording() {
    vkDestroyFence(context->device, fence, nullptr);
    for (VkDescriptorPool p : descriptorPools) vkDestroyDescriptorPool(context->device, p, nullptr);
    vkDestroyQueryPool(context->device, queries, nullptr);
    vkDestroyQueryPool(context->device, statistics, nullptr);
    vkDestroyCommandPool(context->device, pool, nullptr);
}

Result<std::unique_ptr<Recording>> Recording::create(const ContextPtr& context) {
    std::unique_ptr<Recording> recording(new Recording(context));
    const auto fence = make<VkFenceCreateInfo>(VK_STRUCTURE_TYPE_FENCE_CREATE_INFO);
    VkResult r = vkCreateFence(context->device, &fence, nullptr, &recording->fence);
    if (r != VK_SUCCESS) return context->failed(r, "creating a command list");
    auto pool = make<VkCommandPoolCreateInfo>(VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO);
    pool.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
    pool.queueFamilyIndex = context->queueFamily;
    r = vkCreateCommandPool(context->device, &pool, nullptr, &recording->pool);
    if (r != VK_SUCCESS) return context->failed(r, "creating a command list");
    auto info = make<VkCommandBufferAllocateInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO);
    info.commandPool = recording->pool;
    info.commandBufferCount = 1;
    r = vkAllocateCommandBuffers(context->device, &info, &recording->commands);
    if (r != VK_SUCCESS) return context->failed(r, "creating a command list");
    if (context->info.timestampPeriodNs > 0) {
        auto query = make<VkQueryPoolCreateInfo>(VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO);
        query.queryType = VK_QUERY_TYPE_TIMESTAMP;
        query.queryCount = 2 * kMaxPasses;
        r = vkCreateQueryPool(context->device, &query, nullptr, &recording->queries);
        if (r != VK_SUCCESS) return context->failed(r, "creating a command list");
    }
    if (context->countsWork) {
        auto query = make<VkQueryPoolCreateInfo>(VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO);
        query.queryType = VK_QUERY_TYPE_PIPELINE_STATISTICS;
        query.queryCount = kMaxPasses;
        query.pipelineStatistics = kStatistics;
        r = vkCreateQueryPool(context->device, &query, nullptr, &recording->statistics);
        if (r != VK_SUCCESS) return context->failed(r, "creating a command list");
    }
    return recording;
}

Status Recording::reset() {
    retained.clear();
    passes.clear();
    descriptorPoolsUsed = 0;
    VkResult r = vkResetFences(context->device, 1, &fence);
    if (r == VK_SUCCESS) r = vkResetCommandPool(context->device, pool, 0);
    for (VkDescriptorPool p : descriptorPools) {
        if (r == VK_SUCCESS) r = vkResetDescriptorPool(context->device, p, 0);
    }
    if (r != VK_SUCCESS) return context->failed(r, "reusing a command list");
    return {};
}

Result<std::unique_ptr<Recording>> RecordingStore::take() {
    if (idle_.empty()) return Recording::create(context_);
    auto recording = std::move(idle_.back());
    idle_.pop_back();
    return recording;
}

void RecordingStore::giveBack(std::unique_ptr<Recording> recording) {
    // A device that is lost gets no more work.
    if (recording->reset()) idle_.push_back(std::move(recording));
}

Result<std::unique_ptr<CommandListImpl>> CommandListImpl::create(RecordingStore& store,
                                                                 std::function<void()> onClose) {
    auto recording = store.take();
    if (!recording) return tl::unexpected(recording.error());
    auto begin = make<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    const VkResult r = vkBeginCommandBuffer((*recording)->commands, &begin);
    if (r != VK_SUCCESS) return (*recording)->context->failed(r, "creating a command list");
    return std::unique_ptr<CommandListImpl>(new CommandListImpl(std::move(*recording), std::move(onClose)));
}

CommandListImpl::CommandListImpl(std::unique_ptr<Recording> recording, std::function<void()> onClose)
    : recording_(std::move(recording)), onClose_(std::move(onClose)) {
    arena_.buffer = recording_->arena;
}

CommandListImpl::~CommandListImpl() {
    if (onClose_) onClose_();
}

Result<CommandListImpl::Staged> CommandListImpl::stage(std::span<const std::byte> bytes) {
    const std::uint64_t needed = (bytes.size() + kArenaAlignment - 1) / kArenaAlignment * kArenaAlignment;
    if (arena_.buffer == nullptr || arenaUsed_ + needed > arena_.buffer->desc().size) {
        BufferDesc desc;
        desc.name = "upload";
        desc.size = std::max(kArenaBytes, needed);
        desc.usage = Usage::Constant;
        auto buffer = BufferImpl::create(recording_->context, desc, MemoryUse::Upload);
        if (!buffer) return tl::unexpected(buffer.error());
        recording_->retained.push_back(*buffer);
        if (recording_->arena == nullptr && desc.size == kArenaBytes) recording_->arena = *buffer;
        arena_.buffer = *buffer;
        arenaUsed_ = 0;
    }
    Staged staged{arena_.buffer, arenaUsed_};
    std::memcpy(arena_.buffer->memory.mapped() + arenaUsed_, bytes.data(), bytes.size());
    arenaUsed_ += needed;
    stagedBytes_ += needed;
    return staged;
}

void CommandListImpl::writeTimestamp(bool end) {
    if (recording_->queries == VK_NULL_HANDLE) return;
    const auto query = static_cast<std::uint32_t>(2 * (recording_->passes.size() - 1) + (end ? 1 : 0));
    if (!end) vkCmdResetQueryPool(recording_->commands, recording_->queries, query, 2);
    vkCmdWriteTimestamp2(recording_->commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, recording_->queries,
                         query);
}

void CommandListImpl::beginStatistics() {
    if (recording_->statistics == VK_NULL_HANDLE) return;
    const auto query = static_cast<std::uint32_t>(recording_->passes.size() - 1);
    recording_->passes.back().counted = true;
    vkCmdResetQueryPool(recording_->commands, recording_->statistics, query, 1);
    vkCmdBeginQuery(recording_->commands, recording_->statistics, query, 0);
}

void CommandListImpl::endStatistics() {
    if (recording_->statistics == VK_NULL_HANDLE) return;
    vkCmdEndQuery(recording_->commands, recording_->statistics,
                  static_cast<std::uint32_t>(recording_->passes.size() - 1));
}

void CommandListImpl::recordUpdate(const BufferPtr& target, std::uint64_t offset,
                                   std::span<const std::byte> bytes) {
    const auto staged = stage(bytes);
    if (!staged) return wrong(staged.error());
    auto& buffer = static_cast<BufferImpl&>(*target);
    barriers_.use(buffer, kCopyWrite);
    barriers_.flush(recording_->commands);
    const VkBufferCopy copy{staged->offset, offset, bytes.size()};
    vkCmdCopyBuffer(recording_->commands, staged->buffer->handle, buffer.handle, 1, &copy);
}

void CommandListImpl::updateTexture(const TexturePtr& target, std::span<const std::byte> bytes) {
    const auto staged = stage(bytes);
    if (!staged) return wrong(staged.error());
    keep(target);
    auto& texture = static_cast<TextureImpl&>(*target);
    barriers_.use(texture, kCopyWrite);
    barriers_.flush(recording_->commands);
    const VkBufferImageCopy copy = wholeImage(texture, staged->offset);
    vkCmdCopyBufferToImage(recording_->commands, staged->buffer->handle, texture.handle,
                           VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
}

void CommandListImpl::recordCopy(const BufferPlace& source, const BufferPlace& target, std::uint64_t size) {
    barriers_.use(impl(source), kCopyRead);
    barriers_.use(impl(target), kCopyWrite);
    barriers_.flush(recording_->commands);
    const VkBufferCopy copy{source.offset, target.offset, size};
    vkCmdCopyBuffer(recording_->commands, impl(source).handle, impl(target).handle, 1, &copy);
}

void CommandListImpl::recordTextureCopy(const TexturePtr& source, const BufferPlace& target) {
    auto& from = static_cast<TextureImpl&>(*source);
    barriers_.use(from, kCopyRead);
    barriers_.use(impl(target), kCopyWrite);
    barriers_.flush(recording_->commands);
    const VkBufferImageCopy copy = wholeImage(from, target.offset);
    vkCmdCopyImageToBuffer(recording_->commands, from.handle, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                           impl(target).handle, 1, &copy);
}

Result<std::unique_ptr<Recording>> CommandListImpl::finish() {
    if (auto status = checkFinished(); !status) return tl::unexpected(status.error());
    auto barrier = make<VkMemoryBarrier2>(VK_STRUCTURE_TYPE_MEMORY_BARRIER_2);
    barrier.srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    barrier.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
    barrier.dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT;
    barrier.dstAccessMask = VK_ACCESS_2_HOST_READ_BIT;
    auto info = make<VkDependencyInfo>(VK_STRUCTURE_TYPE_DEPENDENCY_INFO);
    info.memoryBarrierCount = 1;
    info.pMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(recording_->commands, &info);
    const VkResult r = vkEndCommandBuffer(recording_->commands);
    if (r != VK_SUCCESS) return recording_->context->failed(r, "recording commands");
    return std::move(recording_);
}

}  // namespace hairloom::gpu::vulkan
