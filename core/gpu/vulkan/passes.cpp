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

}  // namespace

bool CommandListImpl::checkTargets(const PassDesc& desc, std::uint32_t& width, std::uint32_t& height) {
    std::uint32_t samples = 0;
    const auto check = [&](const Texture& texture, Usage usage) {
        const TextureDesc& t = texture.desc();
        if (!has(t.usage, usage))
            return wrong("texture '" + t.name + "' is not made for being a target"), false;
        if (samples == 0) {
            samples = t.samples;
            width = t.width;
            height = t.height;
        }
        if (t.samples != samples || t.width != width || t.height != height) {
            return wrong("target '" + t.name + "' differs from the others in size or samples"), false;
        }
        return true;
    };
    for (const ColourTarget& target : desc.colour) {
        if (target.texture == nullptr) return wrong("a colour target without a texture"), false;
        if (!check(*target.texture, Usage::RenderTarget)) return false;
        if (target.resolve == nullptr) continue;
        const TextureDesc& r = target.resolve->desc();
        if (samples == 1 || r.samples != 1 || r.width != width || r.height != height ||
            r.format != target.texture->desc().format || !has(r.usage, Usage::RenderTarget)) {
            return wrong("texture '" + r.name + "' cannot receive the resolved samples"), false;
        }
    }
    return desc.depth.texture == nullptr || check(*desc.depth.texture, Usage::DepthStencil);
}

void CommandListImpl::beginPass(const PassDesc& desc) {
    if (!requireOutside("beginPass")) return;
    passDesc_ = desc;
    const bool graphics = !desc.colour.empty() || desc.depth.texture != nullptr;
    pass_ = graphics ? PassKind::Graphics : PassKind::Compute;
    if (recording_->passNames.size() == kMaxPasses) wrong("more than 256 passes in one command list");
    if (error_) return;
    recording_->passNames.push_back(desc.name);
    bound_.clear();
    graphics_.reset();
    compute_.reset();
    set_ = VK_NULL_HANDLE;
    draws_.clear();
    current_ = {};
    if (!graphics) return writeTimestamp(false);
    if (!checkTargets(desc, width_, height_)) return;
    setViewport({0, 0, static_cast<float>(width_), static_cast<float>(height_), 0, 1});
    setScissor({0, 0, width_, height_});
    useTargets();
}

void CommandListImpl::useTargets() {
    constexpr Use kColour{VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                          VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
                          VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, true, false};
    for (const ColourTarget& target : passDesc_.colour) {
        Use use = kColour;
        use.discard = target.load != LoadOp::Load;
        barriers_.use(*keep(target.texture), use);
        use.discard = true;
        if (target.resolve) barriers_.use(*keep(target.resolve), use);
    }
    if (passDesc_.depth.texture == nullptr) return;
    barriers_.use(
        *keep(passDesc_.depth.texture),
        {VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
         VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
         VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, true, passDesc_.depth.load != LoadOp::Load});
}

void CommandListImpl::beginRendering() {
    std::vector<VkRenderingAttachmentInfo> colour;
    for (const ColourTarget& target : passDesc_.colour) {
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
    if (passDesc_.depth.texture) {
        depth.imageView = static_cast<TextureImpl&>(*passDesc_.depth.texture).view;
        depth.imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
        depth.loadOp = toVulkan(passDesc_.depth.load);
        depth.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
        depth.clearValue.depthStencil.depth = passDesc_.depth.clear;
        info.pDepthAttachment = &depth;
    }
    info.renderArea.extent = {width_, height_};
    info.layerCount = 1;
    info.colorAttachmentCount = static_cast<std::uint32_t>(colour.size());
    info.pColorAttachments = colour.data();
    vkCmdBeginRendering(recording_->commands, &info);
}

void CommandListImpl::endPass() {
    if (pass_ == PassKind::None) return wrong("endPass without beginPass");
    const PassKind kind = pass_;
    if (!error_) {
        if (kind == PassKind::Graphics) {
            barriers_.flush(recording_->commands);
            writeTimestamp(false);
            beginRendering();
            for (const DrawCall& call : draws_) replay(call);
            vkCmdEndRendering(recording_->commands);
        }
        writeTimestamp(true);
    }
    pass_ = PassKind::None;
}

void CommandListImpl::setPipeline(const GraphicsPipelinePtr& pipeline) {
    if (!requirePass(PassKind::Graphics, "setPipeline")) return;
    if (pipeline == nullptr) return wrong("setPipeline without a pipeline");
    graphics_ = std::static_pointer_cast<const GraphicsPipelineImpl>(pipeline);
    keep(pipeline);
    set_ = VK_NULL_HANDLE;
}

void CommandListImpl::setPipeline(const ComputePipelinePtr& pipeline) {
    if (!requirePass(PassKind::Compute, "setPipeline")) return;
    if (pipeline == nullptr) return wrong("setPipeline without a pipeline");
    compute_ = std::static_pointer_cast<const ComputePipelineImpl>(pipeline);
    keep(pipeline);
    set_ = VK_NULL_HANDLE;
}

void CommandListImpl::setVertexBuffer(const BufferPtr& buffer, std::uint64_t offset) {
    if (!requirePass(PassKind::Graphics, "setVertexBuffer")) return;
    if (buffer == nullptr || !has(buffer->desc().usage, Usage::Vertex) || offset >= buffer->desc().size) {
        return wrong("setVertexBuffer needs a vertex buffer and an offset inside it");
    }
    BufferImpl* impl = keep(buffer);
    current_.vertexBuffer = impl->handle;
    current_.vertexOffset = offset;
    barriers_.use(*impl, {VK_PIPELINE_STAGE_2_VERTEX_ATTRIBUTE_INPUT_BIT,
                          VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT, VK_IMAGE_LAYOUT_UNDEFINED, false, false});
}

void CommandListImpl::setIndexBuffer(const BufferPtr& buffer, std::uint64_t offset) {
    if (!requirePass(PassKind::Graphics, "setIndexBuffer")) return;
    if (buffer == nullptr || !has(buffer->desc().usage, Usage::Index) || offset >= buffer->desc().size) {
        return wrong("setIndexBuffer needs an index buffer and an offset inside it");
    }
    BufferImpl* impl = keep(buffer);
    current_.indexBuffer = impl->handle;
    current_.indexOffset = offset;
    barriers_.use(*impl, {VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT, VK_ACCESS_2_INDEX_READ_BIT,
                          VK_IMAGE_LAYOUT_UNDEFINED, false, false});
}

void CommandListImpl::setViewport(const Viewport& v) {
    if (!requirePass(PassKind::Graphics, "setViewport")) return;
    // A negative height turns Vulkan's downward y axis into Direct3D's.
    current_.viewport = {v.x, v.y + v.height, v.width, -v.height, v.minDepth, v.maxDepth};
}

void CommandListImpl::setScissor(const ScissorRect& s) {
    if (!requirePass(PassKind::Graphics, "setScissor")) return;
    current_.scissor = {{static_cast<std::int32_t>(s.x), static_cast<std::int32_t>(s.y)},
                        {s.width, s.height}};
}

void CommandListImpl::addDraw(DrawCall call) {
    if (!requirePass(PassKind::Graphics, "draw") || error_) return;
    if (graphics_ == nullptr) return wrong("draw without a pipeline");
    const GraphicsPipelineDesc& desc = graphics_->desc;
    const auto& colour = passDesc_.colour;
    bool fits = desc.colourFormats.size() == colour.size();
    for (std::size_t i = 0; fits && i < colour.size(); ++i) {
        fits = desc.colourFormats[i] == colour[i].texture->desc().format;
    }
    const Format depth = passDesc_.depth.texture ? passDesc_.depth.texture->desc().format : Format::Unknown;
    const TexturePtr& any = colour.empty() ? passDesc_.depth.texture : colour[0].texture;
    fits = fits && depth == desc.depthFormat && any->desc().samples == desc.samples;
    if (!fits) return wrong("pipeline '" + desc.name + "' is made for other targets");
    if (!desc.attributes.empty() && call.vertexBuffer == VK_NULL_HANDLE) {
        return wrong("pipeline '" + desc.name + "' needs a vertex buffer");
    }
    call.pipeline = graphics_.get();
    call.set = makeSet(graphics_->core, kGraphicsShaders);
    if (!error_) draws_.push_back(call);
}

void CommandListImpl::draw(std::uint32_t vertices, std::uint32_t instances, std::uint32_t firstVertex,
                           std::uint32_t firstInstance) {
    DrawCall call = current_;
    call.arguments = DrawCall::Direct{vertices, instances, firstVertex, firstInstance};
    addDraw(call);
}

void CommandListImpl::drawIndexed(std::uint32_t indices, std::uint32_t instances, std::uint32_t firstIndex,
                                  std::int32_t vertexOffset, std::uint32_t firstInstance) {
    if (current_.indexBuffer == VK_NULL_HANDLE) return wrong("drawIndexed without an index buffer");
    DrawCall call = current_;
    call.arguments = DrawCall::Indexed{indices, instances, firstIndex, vertexOffset, firstInstance};
    addDraw(call);
}

void CommandListImpl::drawIndirect(const BufferPtr& arguments, std::uint64_t offset) {
    if (arguments == nullptr || !has(arguments->desc().usage, Usage::Indirect) || offset % 4 != 0 ||
        arguments->desc().size < 16 || offset > arguments->desc().size - 16) {
        return wrong("drawIndirect needs 16 bytes of an indirect buffer");
    }
    BufferImpl* impl = keep(arguments);
    barriers_.use(*impl, {VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT, VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT,
                          VK_IMAGE_LAYOUT_UNDEFINED, false, false});
    DrawCall call = current_;
    call.arguments = DrawCall::Indirect{impl->handle, offset};
    addDraw(call);
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
    if (const auto* direct = std::get_if<DrawCall::Direct>(&call.arguments)) {
        vkCmdDraw(cmd, direct->vertices, direct->instances, direct->firstVertex, direct->firstInstance);
    } else if (const auto* indexed = std::get_if<DrawCall::Indexed>(&call.arguments)) {
        vkCmdBindIndexBuffer(cmd, call.indexBuffer, call.indexOffset, VK_INDEX_TYPE_UINT32);
        vkCmdDrawIndexed(cmd, indexed->indices, indexed->instances, indexed->firstIndex,
                         indexed->vertexOffset, indexed->firstInstance);
    } else if (const auto* indirect = std::get_if<DrawCall::Indirect>(&call.arguments)) {
        vkCmdDrawIndirect(cmd, indirect->buffer, indirect->offset, 1, 16);
    }
}

bool CommandListImpl::prepareDispatch() {
    if (!requirePass(PassKind::Compute, "dispatch") || error_) return false;
    if (compute_ == nullptr) return wrong("dispatch without a pipeline"), false;
    const VkDescriptorSet set = makeSet(compute_->core, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT);
    if (error_) return false;
    VkCommandBuffer cmd = recording_->commands;
    barriers_.flush(cmd);
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, compute_->core.handle);
    vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, compute_->core.layout, 0, 1, &set, 0,
                            nullptr);
    return true;
}

void CommandListImpl::dispatch(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    if (x > 65535 || y > 65535 || z > 65535) return wrong("more than 65535 groups along one axis");
    if (prepareDispatch()) vkCmdDispatch(recording_->commands, x, y, z);
}

void CommandListImpl::dispatchIndirect(const BufferPtr& arguments, std::uint64_t offset) {
    if (arguments == nullptr || !has(arguments->desc().usage, Usage::Indirect) || offset % 4 != 0 ||
        arguments->desc().size < 12 || offset > arguments->desc().size - 12) {
        return wrong("dispatchIndirect needs 12 bytes of an indirect buffer");
    }
    BufferImpl* impl = keep(arguments);
    barriers_.use(*impl, {VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT, VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT,
                          VK_IMAGE_LAYOUT_UNDEFINED, false, false});
    if (prepareDispatch()) vkCmdDispatchIndirect(recording_->commands, impl->handle, offset);
}

}  // namespace hairloom::gpu::vulkan
