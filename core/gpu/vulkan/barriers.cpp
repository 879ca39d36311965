// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/gpu/vulkan/barriers.h"

namespace hairloom::gpu::vulkan {

BarrierTracker::Transition BarrierTracker::advance(AccessState& state, const Use& use, bool isTexture) {
    Transition t;
    t.oldLayout = state.layout;
    t.targetStages = use.stages;
    t.targetAccess = use.access;
    const bool layoutChange = isTexture && state.layout != use.layout;
    if (use.write || layoutChange) {
        t.needed = layoutChange || state.writeStages != 0 || state.readStages != 0;
        t.sourceStages = state.writeStages | state.readStages;
        t.sourceAccess = state.writeAccess;
        state.writeStages = use.stages;
        state.writeAccess = use.write ? use.access : VK_ACCESS_2_NONE;
        state.readStages = use.write ? VK_PIPELINE_STAGE_2_NONE : use.stages;
        state.readAccess = use.write ? VK_ACCESS_2_NONE : use.access;
    } else {
        const bool seen = (use.stages & ~state.readStages) == 0 && (use.access & ~state.readAccess) == 0;
        t.needed = state.writeStages != 0 && !seen;
        t.sourceStages = state.writeStages;
        t.sourceAccess = state.writeAccess;
        state.readStages |= use.stages;
        state.readAccess |= use.access;
        // Every reader so far waits again, so that the two masks hold in any combination.
        t.targetStages = state.readStages;
        t.targetAccess = state.readAccess;
    }
    if (isTexture) state.layout = use.layout;
    return t;
}

/// What barriers of buffers and of textures have in common.
template <class Barrier>
Barrier BarrierTracker::barrierFor(VkStructureType type, const Transition& t) {
    auto barrier = make<Barrier>(type);
    barrier.srcStageMask = t.sourceStages;
    barrier.srcAccessMask = t.sourceAccess;
    barrier.dstStageMask = t.targetStages;
    barrier.dstAccessMask = t.targetAccess;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    return barrier;
}

void BarrierTracker::use(BufferImpl& buffer, const Use& use) {
    AccessState& state = buffers_.try_emplace(&buffer, buffer.state).first->second;
    const Transition t = advance(state, use, false);
    if (!t.needed) return;
    auto barrier = barrierFor<VkBufferMemoryBarrier2>(VK_STRUCTURE_TYPE_BUFFER_MEMORY_BARRIER_2, t);
    barrier.buffer = buffer.handle;
    barrier.size = VK_WHOLE_SIZE;
    bufferBarriers_.push_back(barrier);
}

void BarrierTracker::use(TextureImpl& texture, const Use& use) {
    AccessState& state = textures_.try_emplace(&texture, texture.state).first->second;
    const Transition t = advance(state, use, true);
    if (!t.needed) return;
    auto barrier = barrierFor<VkImageMemoryBarrier2>(VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2, t);
    barrier.oldLayout = use.discard ? VK_IMAGE_LAYOUT_UNDEFINED : t.oldLayout;
    barrier.newLayout = use.layout;
    barrier.image = texture.handle;
    barrier.subresourceRange = {texture.aspect(), 0, 1, 0, 1};
    imageBarriers_.push_back(barrier);
}

void BarrierTracker::flush(VkCommandBuffer commands) {
    if (bufferBarriers_.empty() && imageBarriers_.empty()) return;
    auto info = make<VkDependencyInfo>(VK_STRUCTURE_TYPE_DEPENDENCY_INFO);
    info.bufferMemoryBarrierCount = static_cast<std::uint32_t>(bufferBarriers_.size());
    info.pBufferMemoryBarriers = bufferBarriers_.data();
    info.imageMemoryBarrierCount = static_cast<std::uint32_t>(imageBarriers_.size());
    info.pImageMemoryBarriers = imageBarriers_.data();
    vkCmdPipelineBarrier2(commands, &info);
    bufferBarriers_.clear();
    imageBarriers_.clear();
}

void BarrierTracker::commit() {
    for (auto& [buffer, state] : buffers_) buffer->state = state;
    for (auto& [texture, state] : textures_) texture->state = state;
}

}  // namespace hairloom::gpu::vulkan
