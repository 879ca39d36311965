// SPDX-License-Identifier: GPL-3.0-or-later
// Submitting, waiting, timestamps and reading back.
#include <algorithm>
#include <array>
#include <cstring>

#include "core/gpu/vulkan/device.h"

namespace hairloom::gpu::vulkan {
namespace {

/// In the order of the bits of kStatistics, as Vulkan writes them.
PassCounts countsOf(VkDevice device, VkQueryPool pool, std::uint32_t query) {
    std::array<std::uint64_t, kStatisticsCount> all{};
    vkGetQueryPoolResults(device, pool, query, 1, sizeof(all), all.data(), sizeof(all),
                          VK_QUERY_RESULT_64_BIT);
    return {all[0], all[1], all[4], all[5], all[2], all[3]};
}

}  // namespace

SubmissionImpl::~SubmissionImpl() {
    if (started_ && !done_) vkDeviceWaitIdle(context_->device);
}

Status SubmissionImpl::start() {
    std::vector<VkCommandBufferSubmitInfo> commands;
    for (const auto& recording : recordings_) {
        auto info = make<VkCommandBufferSubmitInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO);
        info.commandBuffer = recording->commands;
        commands.push_back(info);
    }
    auto info = make<VkSubmitInfo2>(VK_STRUCTURE_TYPE_SUBMIT_INFO_2);
    info.commandBufferInfoCount = static_cast<std::uint32_t>(commands.size());
    info.pCommandBufferInfos = commands.data();
    const VkResult r = vkQueueSubmit2(context_->queue, 1, &info, recordings_.back()->fence);
    if (r != VK_SUCCESS) return context_->failed(r, "submitting work");
    started_ = true;
    return {};
}

void SubmissionImpl::finish() {
    if (done_) return;
    done_ = true;
    const Recording& last = *recordings_.back();
    std::vector<std::uint64_t> ticks(2 * last.passes.size(), 0);
    if (last.queries != VK_NULL_HANDLE && !ticks.empty()) {
        vkGetQueryPoolResults(context_->device, last.queries, 0, static_cast<std::uint32_t>(ticks.size()),
                              ticks.size() * 8, ticks.data(), 8, VK_QUERY_RESULT_64_BIT);
    }
    for (std::size_t i = 0; i < last.passes.size(); ++i) {
        const double spent = static_cast<double>(ticks[2 * i + 1] - ticks[2 * i]);
        times_.push_back({last.passes[i].name, spent * context_->info.timestampPeriodNs * 1e-6});
        if (last.passes[i].counted)
            times_.back().counts = countsOf(context_->device, last.statistics, static_cast<std::uint32_t>(i));
    }
    if (const auto store = store_.lock()) {
        for (auto& recording : recordings_) store->giveBack(std::move(recording));
    }
    recordings_.clear();
}

bool SubmissionImpl::isDone() {
    if (!done_ && vkGetFenceStatus(context_->device, recordings_.back()->fence) == VK_SUCCESS) finish();
    return done_;
}

Status SubmissionImpl::wait() {
    if (done_) return {};
    const auto nanoseconds = static_cast<std::uint64_t>(std::clamp(context_->timeoutSeconds, 0.0, 1e6) * 1e9);
    const VkResult r = vkWaitForFences(context_->device, 1, &recordings_.back()->fence, VK_TRUE, nanoseconds);
    if (r != VK_SUCCESS) return context_->failed(r, "waiting for the GPU");
    finish();
    return {};
}

Result<std::vector<PassTime>> SubmissionImpl::passTimes() {
    if (auto status = wait(); !status) return tl::unexpected(status.error());
    return times_;
}

Status DeviceImpl::copyMapped(const Buffer& buffer, std::uint64_t offset, std::span<std::byte> target) {
    const auto& impl = static_cast<const BufferImpl&>(buffer);
    std::memcpy(target.data(), impl.memory.mapped() + offset, target.size());
    return {};
}

}  // namespace hairloom::gpu::vulkan
