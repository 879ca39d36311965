// SPDX-License-Identifier: GPL-3.0-or-later
// Graphics and compute passes.
#include <algorithm>

#include "core/gpu/vulkan/commands.h"

namespace hairloom::gpu::vulkan {
namespace {

constexpr VkPipelineStageFlags2 kGraphicsShaders =
    VK_PIPELINE_STAGE_2_PRE_RASTERIZATION_SHADERS_BIT | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;

VkAttachmentLoadOp toVulkan(LoadOp load) {
    switch (load) {
        case LoadOp::Clear:
            return VK_ATTACHMENT_LOAD_OP_CLEAR;
        case LoadOp::Load:
            return VK_ATTACHMENT_LOAD_OP_LOAD;
        case LoadOp::Discard:
            break;
    }
    return VK_ATTACHMENT_LOAD_OP_DONT_CARE;
}

VkBuffer handleOf(const BufferPlace& place) {
    return static_cast<const BufferImpl&>(*place.buffer).handle;
}

}  // namespace

void CommandListImpl::recordPassBegin() {
    recording_->passes.push_back({passDesc().name});
    draws_.clear();
    if (passKind() == PassKind::Compute) return writeTimestamp(false);
    useTargets();
}

void CommandListImpl::useTargets() {
    constexpr Use kColour{VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                          VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
                          VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, true, false};
    for (const ColourTarget& target : passDesc().colour) {
        Use use = kColour;
        use.discard = target.load != LoadOp::Load;
        barriers_.use(static_cast<TextureImpl&>(*target.texture), use);
        use.discard = true;
        if (target.resolve) barriers_.use(static_cast<TextureImpl&>(*target.resolve), use);
    }
    if (passDesc().depth.texture == nullptr) return;
    barriers_.use(
        static_cast<TextureImpl&>(*passDesc().depth.texture),
        {VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
         VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
         VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, true, passDesc().depth.load != LoadOp::Load});
}

void CommandListImpl::beginRendering() {
    std::vector<VkRenderingAttachmentInfo> colour;
    for (const ColourTarget& target : passDesc().colour) {
        auto info = make<VkRenderingAttachmentInfo>(VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO);
        info.imageView = static_cast<TextureImpl&>(*target.texture).view;
        info.imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
        info.loadOp = toVulkan(target.load);
        info.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
        std::ranges::copy(target.clear, info.clearValue.color.float32);
        if (target.resolve) {
            info.resolveMode = VK_RESOLVE_MODE_AVERAGE_BIT;
            info.resolveImageView = static_cast<TextureImpl&>(*target.resolve).view;
            info.resolveImageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
        }
        colour.push_back(info);
    }
    auto depth = make<VkRenderingAttachmentInfo>(VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO);
    auto info = make<VkRenderingInfo>(VK_STRUCTURE_TYPE_RENDERING_INFO);
    if (passDesc().depth.texture) {
        depth.imageView = static_cast<TextureImpl&>(*passDesc().depth.texture).view;
        depth.imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
        depth.loadOp = toVulkan(passDesc().depth.load);
        depth.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
        depth.clearValue.depthStencil.depth = passDesc().depth.clear;
        info.pDepthAttachment = &depth;
    }
    info.renderArea.extent = {width(), height()};
    info.layerCount = 1;
    info.colorAttachmentCount = static_cast<std::uint32_t>(colour.size());
    info.pColorAttachments = colour.data();
    vkCmdBeginRendering(recording_->commands, &info);
}

void CommandListImpl::recordPassEnd() {
    if (passKind() == PassKind::Graphics) {
        barriers_.flush(recording_->commands);
        writeTimestamp(false);
        beginStatistics();
        beginRendering();
        for (const DrawCall& call : draws_) replay(call);
        vkCmdEndRendering(recording_->commands);
        endStatistics();
    }
    writeTimestamp(true);
}

void CommandListImpl::usePlace(const BufferPlace& place, VkPipelineStageFlags2 stage, VkAccessFlags2 access) {
    barriers_.use(static_cast<BufferImpl&>(*place.buffer),
                  {stage, access, VK_IMAGE_LAYOUT_UNDEFINED, false, false});
}

void CommandListImpl::recordDraw(const DrawArguments& arguments) {
    DrawCall call;
    const auto& pipeline = static_cast<const GraphicsPipelineImpl&>(graphics());
    call.pipeline = &pipeline;
    call.set = makeSet(pipeline.core, kGraphicsShaders);
    if (failed()) return;
    if (vertices().buffer) {
        usePlace(vertices(), VK_PIPELINE_STAGE_2_VERTEX_ATTRIBUTE_INPUT_BIT,
                 VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT);
        call.vertexBuffer = handleOf(vertices());
        call.vertexOffset = vertices().offset;
    }
    if (indices().buffer) {
        usePlace(indices(), VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT, VK_ACCESS_2_INDEX_READ_BIT);
        call.indexBuffer = handleOf(indices());
        call.indexOffset = indices().offset;
    }
    if (const auto* indirect = std::get_if<BufferPlace>(&arguments)) {
        usePlace(*indirect, VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT, VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT);
    }
    // A negative height turns Vulkan's downward y axis into Direct3D's.
    const Viewport& v = viewport();
    call.viewport = {v.x, v.y + v.height, v.width, -v.height, v.minDepth, v.maxDepth};
    const ScissorRect& s = scissor();
    call.scissor = {{static_cast<std::int32_t>(s.x), static_cast<std::int32_t>(s.y)}, {s.width, s.height}};
    call.arguments = arguments;
    draws_.push_back(std::move(call));
}

void CommandListImpl::replay(const DrawCall& call) {
    VkCommandBuffer cmd = recording_->commands;
    const PipelineCore& core = call.pipeline->core;
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, core.handle);
    vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, core.layout, 0, 1, &call.set, 0, nullptr);
    vkCmdSetViewport(cmd, 0, 1, &call.viewport);
    vkCmdSetScissor(cmd, 0, 1, &call.scissor);
    if (call.vertexBuffer != VK_NULL_HANDLE) {
        vkCmdBindVertexBuffers(cmd, 0, 1, &call.vertexBuffer, &call.vertexOffset);
    }
    if (const auto* direct = std::get_if<DirectDraw>(&call.arguments)) {
        vkCmdDraw(cmd, direct->vertices, direct->instances, direct->firstVertex, direct->firstInstance);
    } else if (const auto* indexed = std::get_if<IndexedDraw>(&call.arguments)) {
        vkCmdBindIndexBuffer(cmd, call.indexBuffer, call.indexOffset, VK_INDEX_TYPE_UINT32);
        vkCmdDrawIndexed(cmd, indexed->indices, indexed->instances, indexed->firstIndex,
                         indexed->vertexOffset, indexed->firstInstance);
    } else if (const auto* indirect = std::get_if<BufferPlace>(&call.arguments)) {
        vkCmdDrawIndirect(cmd, handleOf(*indirect), indirect->offset, 1, 16);
    }
}

void CommandListImpl::recordDispatch(const DispatchArguments& arguments) {
    const auto& core = static_cast<const ComputePipelineImpl&>(compute()).core;
    const VkDescriptorSet set = makeSet(core, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT);
    if (failed()) return;
    const auto* indirect = std::get_if<BufferPlace>(&arguments);
    if (indirect != nullptr) {
        usePlace(*indirect, VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT, VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT);
    }
    VkCommandBuffer cmd = recording_->commands;
    barriers_.flush(cmd);
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, core.handle);
    vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, core.layout, 0, 1, &set, 0, nullptr);
    if (indirect != nullptr) {
        vkCmdDispatchIndirect(cmd, handleOf(*indirect), indirect->offset);
    } else if (const auto* groups = std::get_if<GroupCounts>(&arguments)) {
        vkCmdDispatch(cmd, groups->x, groups->y, groups->z);
    }
}

}  // namespace hairloom::gpu::vulkan
