// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/render/targets.h"

namespace hairloom::render {
namespace {

bool fits(const gpu::TexturePtr& texture, const PlannedTarget& planned) {
    if (texture == nullptr) return planned.width == 0;
    const gpu::TextureDesc& desc = texture->desc();
    return desc.width == planned.width && desc.height == planned.height && desc.format == planned.format &&
           desc.samples == planned.samples;
}

gpu::TextureDesc describe(TargetId id, const PlannedTarget& planned) {
    gpu::TextureDesc desc;
    desc.name = targetName(id);
    desc.width = planned.width;
    desc.height = planned.height;
    desc.format = planned.format;
    desc.samples = planned.samples;
    desc.usage =
        planned.format == gpu::Format::D32Float ? gpu::Usage::DepthStencil : gpu::Usage::RenderTarget;
    if (planned.samples == 1) desc.usage = desc.usage | gpu::Usage::ShaderRead;
    return desc;
}

bool fits(const gpu::BufferPtr& buffer, const PlannedBuffer& planned) {
    if (buffer == nullptr) return planned.elements == 0;
    return buffer->desc().size == planned.bytes() && buffer->desc().elementBytes == planned.elementBytes;
}

gpu::BufferDesc describe(BufferId id, const PlannedBuffer& planned) {
    gpu::BufferDesc desc;
    desc.name = bufferName(id);
    desc.size = planned.bytes();
    desc.elementBytes = planned.elementBytes;
    desc.usage = gpu::Usage::ShaderRead | gpu::Usage::UnorderedAccess;
    return desc;
}

}  // namespace

Result<Targets::New> Targets::fit(gpu::Device& device, const RenderPlan& plan) {
    New isNew;
    for (std::size_t i = 0; i < kTargetCount; ++i) {
        if (fits(textures_[i], plan.targets[i])) continue;
        textures_[i] = nullptr;
        if (plan.targets[i].width == 0) continue;
        auto made = device.createTexture(describe(static_cast<TargetId>(i), plan.targets[i]));
        if (!made) return tl::unexpected(made.error());
        textures_[i] = std::move(*made);
        isNew.textures[i] = true;
    }
    for (std::size_t i = 0; i < kBufferCount; ++i) {
        if (fits(buffers_[i], plan.buffers[i])) continue;
        buffers_[i] = nullptr;
        if (plan.buffers[i].elements == 0) continue;
        auto made = device.createBuffer(describe(static_cast<BufferId>(i), plan.buffers[i]));
        if (!made) return tl::unexpected(made.error());
        buffers_[i] = std::move(*made);
        isNew.buffers[i] = true;
    }
    return isNew;
}

}  // namespace hairloom::render
