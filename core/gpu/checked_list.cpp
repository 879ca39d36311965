// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/gpu/checked_list.h"

namespace hairloom::gpu {
namespace {

bool inRange(std::uint64_t offset, std::uint64_t size, std::uint64_t total) {
    return offset <= total && size <= total - offset;
}

std::string outside(const char* call, const BufferPtr& buffer) {
    return std::string(call) + ": range outside buffer '" + (buffer ? buffer->desc().name : "(none)") + "'";
}

}  // namespace

void CheckedList::wrong(const std::string& what) {
    const std::string where = pass_ == PassKind::None ? std::string() : "pass '" + passDesc_.name + "': ";
    wrong(Error{{}, {}, where + what, {}});
}

void CheckedList::wrong(const Error& error) {
    if (!error_) error_ = error;
}

Status CheckedList::checkFinished() {
    if (pass_ != PassKind::None) wrong("the pass was not ended");
    if (error_) return tl::unexpected(*error_);
    return {};
}

bool CheckedList::requirePass(PassKind kind, const char* call) {
    if (pass_ == kind) return !error_;
    wrong(std::string(call) +
          (kind == PassKind::Graphics ? " outside a graphics pass" : " outside a compute pass"));
    return false;
}

bool CheckedList::requireOutside(const char* call) {
    if (pass_ == PassKind::None) return !error_;
    wrong(std::string(call) + " inside a pass");
    return false;
}

bool CheckedList::checkTarget(const Texture& texture, Usage usage, std::uint32_t& samples) {
    const TextureDesc& t = texture.desc();
    if (!has(t.usage, usage)) return wrong("texture '" + t.name + "' is not made for being a target"), false;
    if (samples == 0) {
        samples = t.samples;
        width_ = t.width;
        height_ = t.height;
    }
    if (t.samples != samples || t.width != width_ || t.height != height_) {
        return wrong("target '" + t.name + "' differs from the others in size or samples"), false;
    }
    return true;
}

bool CheckedList::checkTargets(const PassDesc& desc) {
    std::uint32_t samples = 0;
    for (const ColourTarget& target : desc.colour) {
        if (target.texture == nullptr) return wrong("a colour target without a texture"), false;
        if (!checkTarget(*target.texture, Usage::RenderTarget, samples)) return false;
        if (target.resolve == nullptr) continue;
        const TextureDesc& r = target.resolve->desc();
        if (samples == 1 || r.samples != 1 || r.width != width_ || r.height != height_ ||
            r.format != target.texture->desc().format || !has(r.usage, Usage::RenderTarget)) {
            return wrong("texture '" + r.name + "' cannot receive the resolved samples"), false;
        }
    }
    return desc.depth.texture == nullptr || checkTarget(*desc.depth.texture, Usage::DepthStencil, samples);
}

void CheckedList::beginPass(const PassDesc& desc) {
    if (!requireOutside("beginPass")) return;
    passDesc_ = desc;
    const bool graphics = !desc.colour.empty() || desc.depth.texture != nullptr;
    pass_ = graphics ? PassKind::Graphics : PassKind::Compute;
    if (passCount_ == kMaxPasses) return wrong("more than 256 passes in one command list");
    ++passCount_;
    bound_.clear();
    graphics_.reset();
    compute_.reset();
    vertices_ = indices_ = {};
    if (graphics) {
        if (!checkTargets(desc)) return;
        viewport_ = {0, 0, static_cast<float>(width_), static_cast<float>(height_), 0, 1};
        scissor_ = {0, 0, width_, height_};
        for (const ColourTarget& target : desc.colour) {
            keep(target.texture);
            if (target.resolve) keep(target.resolve);
        }
        if (desc.depth.texture) keep(desc.depth.texture);
    }
    bindingsChanged();
    recordPassBegin();
}

void CheckedList::endPass() {
    if (pass_ == PassKind::None) return wrong("endPass without beginPass");
    if (!error_) recordPassEnd();
    pass_ = PassKind::None;
}

void CheckedList::setPipeline(const GraphicsPipelinePtr& pipeline) {
    if (!requirePass(PassKind::Graphics, "setPipeline")) return;
    if (pipeline == nullptr) return wrong("setPipeline without a pipeline");
    graphics_ = std::static_pointer_cast<const CheckedGraphicsPipeline>(pipeline);
    keep(pipeline);
    bindingsChanged();
}

void CheckedList::setPipeline(const ComputePipelinePtr& pipeline) {
    if (!requirePass(PassKind::Compute, "setPipeline")) return;
    if (pipeline == nullptr) return wrong("setPipeline without a pipeline");
    compute_ = std::static_pointer_cast<const CheckedComputePipeline>(pipeline);
    keep(pipeline);
    bindingsChanged();
}

void CheckedList::bind(std::span<const Binding> bindings) {
    if (pass_ == PassKind::None) return wrong("bind outside a pass");
    for (const Binding& binding : bindings) {
        bound_[{binding.kind, binding.slot}] = binding;
        if (binding.buffer) keep(binding.buffer);
        if (binding.texture) keep(binding.texture);
        if (binding.sampler) keep(binding.sampler);
    }
    bindingsChanged();
}

void CheckedList::setConstants(std::uint32_t slot, std::span<const std::byte> bytes) {
    if (pass_ == PassKind::None) return wrong("setConstants outside a pass");
    if (bytes.empty() || bytes.size() > kMaxConstantBytes) {
        return wrong("constants of 1 to 65536 bytes are possible");
    }
    if (error_) return;
    uploadedBytes_ += bytes.size();
    const auto staged = stageConstants(slot, bytes);
    if (!staged) return wrong(staged.error());
    bind({&*staged, 1});
}

void CheckedList::setVertexBuffer(const BufferPtr& buffer, std::uint64_t offset) {
    if (!requirePass(PassKind::Graphics, "setVertexBuffer")) return;
    if (buffer == nullptr || !has(buffer->desc().usage, Usage::Vertex) || offset >= buffer->desc().size) {
        return wrong("setVertexBuffer needs a vertex buffer and an offset inside it");
    }
    keep(buffer);
    vertices_ = {buffer, offset};
}

void CheckedList::setIndexBuffer(const BufferPtr& buffer, std::uint64_t offset) {
    if (!requirePass(PassKind::Graphics, "setIndexBuffer")) return;
    if (buffer == nullptr || !has(buffer->desc().usage, Usage::Index) || offset >= buffer->desc().size) {
        return wrong("setIndexBuffer needs an index buffer and an offset inside it");
    }
    keep(buffer);
    indices_ = {buffer, offset};
}

void CheckedList::setViewport(const Viewport& viewport) {
    if (requirePass(PassKind::Graphics, "setViewport")) viewport_ = viewport;
}

void CheckedList::setScissor(const ScissorRect& scissor) {
    if (requirePass(PassKind::Graphics, "setScissor")) scissor_ = scissor;
}

bool CheckedList::checkRegisters(const std::string& pipeline, const RegisterUses& uses) {
    for (const RegisterUse& use : uses.all()) {
        const std::string where = "register " + toString(use.at) + " of pipeline '" + pipeline + "'";
        const auto found = bound_.find(use.at);
        if (found == bound_.end()) return wrong(where + " is not bound"), false;
        if (auto status = checkBinding(use, found->second, where); !status) {
            return wrong(status.error().problem), false;
        }
    }
    return true;
}

bool CheckedList::targetsFit(const GraphicsPipelineDesc& desc) const {
    const auto& colour = passDesc_.colour;
    bool fits = desc.colourFormats.size() == colour.size();
    for (std::size_t i = 0; fits && i < colour.size(); ++i) {
        fits = desc.colourFormats[i] == colour[i].texture->desc().format;
    }
    const Format depth = passDesc_.depth.texture ? passDesc_.depth.texture->desc().format : Format::Unknown;
    const TexturePtr& any = colour.empty() ? passDesc_.depth.texture : colour[0].texture;
    return fits && depth == desc.depthFormat && any->desc().samples == desc.samples;
}

void CheckedList::addDraw(const DrawArguments& arguments) {
    if (!requirePass(PassKind::Graphics, "draw")) return;
    if (graphics_ == nullptr) return wrong("draw without a pipeline");
    const GraphicsPipelineDesc& desc = graphics_->desc;
    if (!targetsFit(desc)) return wrong("pipeline '" + desc.name + "' is made for other targets");
    if (!desc.attributes.empty() && vertices_.buffer == nullptr) {
        return wrong("pipeline '" + desc.name + "' needs a vertex buffer");
    }
    if (checkRegisters(desc.name, graphics_->uses)) recordDraw(arguments);
}

void CheckedList::draw(std::uint32_t vertices, std::uint32_t instances, std::uint32_t firstVertex,
                       std::uint32_t firstInstance) {
    addDraw(DirectDraw{vertices, instances, firstVertex, firstInstance});
}

void CheckedList::drawIndexed(std::uint32_t indices, std::uint32_t instances, std::uint32_t firstIndex,
                              std::int32_t vertexOffset, std::uint32_t firstInstance) {
    if (indices_.buffer == nullptr) return wrong("drawIndexed without an index buffer");
    addDraw(IndexedDraw{indices, instances, firstIndex, vertexOffset, firstInstance});
}

bool CheckedList::checkArguments(const BufferPtr& arguments, std::uint64_t offset, std::uint64_t size,
                                 const char* call) {
    if (arguments == nullptr || !has(arguments->desc().usage, Usage::Indirect) || offset % 4 != 0 ||
        !inRange(offset, size, arguments->desc().size)) {
        return wrong(std::string(call) + " needs " + std::to_string(size) + " bytes of an indirect buffer"),
               false;
    }
    keep(arguments);
    return true;
}

void CheckedList::drawIndirect(const BufferPtr& arguments, std::uint64_t offset) {
    if (checkArguments(arguments, offset, 16, "drawIndirect")) addDraw(BufferPlace{arguments, offset});
}

void CheckedList::addDispatch(const DispatchArguments& arguments) {
    if (!requirePass(PassKind::Compute, "dispatch")) return;
    if (compute_ == nullptr) return wrong("dispatch without a pipeline");
    if (checkRegisters(compute_->desc.name, compute_->uses)) recordDispatch(arguments);
}

void CheckedList::dispatch(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    if (x > 65535 || y > 65535 || z > 65535) return wrong("more than 65535 groups along one axis");
    addDispatch(GroupCounts{x, y, z});
}

void CheckedList::dispatchIndirect(const BufferPtr& arguments, std::uint64_t offset) {
    if (checkArguments(arguments, offset, 12, "dispatchIndirect"))
        addDispatch(BufferPlace{arguments, offset});
}

void CheckedList::updateBuffer(const BufferPtr& target, std::uint64_t offset,
                               std::span<const std::byte> bytes) {
    if (!requireOutside("updateBuffer")) return;
    if (target == nullptr || bytes.empty() || !inRange(offset, bytes.size(), target->desc().size)) {
        return wrong(outside("updateBuffer", target));
    }
    keep(target);
    uploadedBytes_ += bytes.size();
    recordUpdate(target, offset, bytes);
}

void CheckedList::copyBuffer(const BufferPtr& source, std::uint64_t sourceOffset, const BufferPtr& target,
                             std::uint64_t targetOffset, std::uint64_t size) {
    if (!requireOutside("copyBuffer")) return;
    if (source == nullptr || target == nullptr || source == target) {
        return wrong("copyBuffer needs two different buffers");
    }
    if (size == 0 || !inRange(sourceOffset, size, source->desc().size))
        return wrong(outside("copyBuffer", source));
    if (!inRange(targetOffset, size, target->desc().size)) return wrong(outside("copyBuffer", target));
    keep(source);
    keep(target);
    recordCopy({source, sourceOffset}, {target, targetOffset}, size);
}

void CheckedList::copyTextureToBuffer(const TexturePtr& source, const BufferPtr& target,
                                      std::uint64_t targetOffset) {
    if (!requireOutside("copyTextureToBuffer")) return;
    if (source == nullptr || target == nullptr)
        return wrong("copyTextureToBuffer needs a texture and a buffer");
    const TextureDesc& desc = source->desc();
    if (desc.samples != 1) return wrong("copy of multisampled texture '" + desc.name + "': resolve it first");
    const std::uint64_t size = std::uint64_t{desc.width} * desc.height * bytesPerTexel(desc.format);
    if (targetOffset % 16 != 0 || !inRange(targetOffset, size, target->desc().size)) {
        return wrong(outside("copyTextureToBuffer", target));
    }
    keep(source);
    keep(target);
    recordTextureCopy(source, {target, targetOffset});
}

}  // namespace hairloom::gpu
