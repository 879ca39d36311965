// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/gpu/validation_commands.h"

#include <fmt/format.h>

#include <algorithm>

namespace hairloom::gpu {
namespace {

std::string describe(const BufferPtr& buffer) {
    return "buffer '" + buffer->desc().name + "'";
}
std::string describe(const TexturePtr& texture) {
    return "texture '" + texture->desc().name + "'";
}

}  // namespace

void ValidationCommandList::wrong(const std::string& what) {
    if (error_) return;
    error_ = Error{{}, {}, pass_.name.empty() ? what : "pass '" + pass_.name + "': " + what, {}};
}

bool ValidationCommandList::hasContent(const std::shared_ptr<const void>& resource) const {
    if (std::ranges::find(written_, resource) != written_.end()) return true;
    const auto known = contents_.find(resource);
    // What came from elsewhere (a swap chain's back buffer) is not watched.
    return known == contents_.end() || known->second.written;
}

void ValidationCommandList::use(RecordedWork& work, const Used& used) {
    if (used.write) {
        work.writes.push_back(used.name);
        written_.push_back(used.resource);
    } else {
        work.reads.push_back(used.name);
        if (!hasContent(used.resource)) wrong(used.name + " is read, and nothing has written it");
    }
}

void ValidationCommandList::beginPass(const PassDesc& desc) {
    pass_ = desc;
    graphics_.reset();
    compute_.reset();
    bound_.clear();
    vertices_.reset();
    indices_.reset();
    const auto begin = [&](const TexturePtr& texture, LoadOp load) {
        if (texture == nullptr) return;
        if (load == LoadOp::Load && !hasContent(texture))
            wrong(describe(texture) + " is loaded, and nothing has written it");
        if (load != LoadOp::Discard) written_.push_back(texture);
    };
    for (const ColourTarget& target : desc.colour) {
        begin(target.texture, target.load);
        if (target.resolve) written_.push_back(target.resolve);
    }
    begin(desc.depth.texture, desc.depth.load);
    inner_->beginPass(desc);
}

void ValidationCommandList::endPass() {
    pass_ = {};
    inner_->endPass();
}

void ValidationCommandList::setPipeline(const GraphicsPipelinePtr& pipeline) {
    graphics_ = pipeline;
    inner_->setPipeline(pipeline);
}

void ValidationCommandList::setPipeline(const ComputePipelinePtr& pipeline) {
    compute_ = pipeline;
    inner_->setPipeline(pipeline);
}

void ValidationCommandList::bind(std::span<const Binding> bindings) {
    for (const Binding& binding : bindings) bound_[{binding.kind, binding.slot}] = binding;
    inner_->bind(bindings);
}

void ValidationCommandList::setConstants(std::uint32_t slot, std::span<const std::byte> bytes) {
    bound_[{Binding::Kind::ConstantBuffer, slot}] = {};
    inner_->setConstants(slot, bytes);
}

void ValidationCommandList::setVertexBuffer(const BufferPtr& buffer, std::uint64_t offset) {
    vertices_ = buffer;
    vertexOffset_ = offset;
    inner_->setVertexBuffer(buffer, offset);
}

void ValidationCommandList::setIndexBuffer(const BufferPtr& buffer, std::uint64_t offset) {
    indices_ = buffer;
    indexOffset_ = offset;
    inner_->setIndexBuffer(buffer, offset);
}

void ValidationCommandList::gatherRegisters(std::vector<Used>& used, const Pipeline& pipeline) const {
    for (const ShaderRegister& wanted : pipeline.registers()) {
        const auto found = bound_.find(wanted);
        if (found == bound_.end()) continue;  // the backend says so
        const bool write = wanted.kind == Binding::Kind::UnorderedAccess;
        const Binding& binding = found->second;
        if (binding.buffer) used.push_back({binding.buffer, describe(binding.buffer), write});
        if (binding.texture) used.push_back({binding.texture, describe(binding.texture), write});
    }
}

std::vector<ValidationCommandList::Used> ValidationCommandList::targets() const {
    std::vector<Used> all;
    const auto add = [&](const TexturePtr& texture) {
        if (texture) all.push_back({texture, describe(texture), true});
    };
    for (const ColourTarget& target : pass_.colour) {
        add(target.texture);
        add(target.resolve);
    }
    add(pass_.depth.texture);
    return all;
}

void ValidationCommandList::run(RecordedWork::Kind kind, const Pipeline* pipeline,
                                const BufferPtr& arguments) {
    if (pipeline == nullptr || error_) return;  // the backend refuses work without a pipeline
    RecordedWork work{kind, pass_.name, pipeline->name(), {}, {}};
    std::vector<Used> used;
    gatherRegisters(used, *pipeline);
    if (kind == RecordedWork::Kind::Draw) {
        if (vertices_) used.push_back({vertices_, describe(vertices_), false});
        if (indices_) used.push_back({indices_, describe(indices_), false});
    }
    if (arguments) used.push_back({arguments, describe(arguments), false});
    std::ranges::move(targets(), std::back_inserter(used));
    for (const Used& reader : used) {
        const auto sameWritten = [&](const Used& other) {
            return other.write && other.resource == reader.resource;
        };
        if (!reader.write && std::ranges::any_of(used, sameWritten))
            wrong("pipeline '" + work.pipeline + "' reads " + reader.name + " while it is written");
    }
    // Reads first: what this work writes does not count as content for it.
    std::stable_partition(used.begin(), used.end(), [](const Used& u) { return !u.write; });
    for (const Used& one : used) use(work, one);
    record_.push_back(std::move(work));
}

void ValidationCommandList::checkVertices(std::uint64_t lastVertex) {
    const GraphicsPipelineDesc* desc = graphics_ == nullptr ? nullptr : pipelineOf_(graphics_);
    if (desc == nullptr || desc->vertexStride == 0 || vertices_ == nullptr) return;
    const std::uint64_t end = vertexOffset_ + lastVertex * desc->vertexStride;
    if (end > vertices_->desc().size)
        wrong(fmt::format("{} vertices end at byte {} of {}, which has {}", lastVertex, end,
                          describe(vertices_), vertices_->desc().size));
}

void ValidationCommandList::draw(std::uint32_t vertices, std::uint32_t instances, std::uint32_t firstVertex,
                                 std::uint32_t firstInstance) {
    checkVertices(std::uint64_t{firstVertex} + vertices);
    run(RecordedWork::Kind::Draw, graphics_.get(), nullptr);
    if (!error_) inner_->draw(vertices, instances, firstVertex, firstInstance);
}

void ValidationCommandList::drawIndexed(std::uint32_t indices, std::uint32_t instances,
                                        std::uint32_t firstIndex, std::int32_t vertexOffset,
                                        std::uint32_t firstInstance) {
    if (indices_) {
        const std::uint64_t end = indexOffset_ + 4 * (std::uint64_t{firstIndex} + indices);
        if (end > indices_->desc().size)
            wrong(fmt::format("indices end at byte {} of {}, which has {}", end, describe(indices_),
                              indices_->desc().size));
    }
    run(RecordedWork::Kind::Draw, graphics_.get(), nullptr);
    if (!error_) inner_->drawIndexed(indices, instances, firstIndex, vertexOffset, firstInstance);
}

void ValidationCommandList::drawIndirect(const BufferPtr& arguments, std::uint64_t offset) {
    run(RecordedWork::Kind::Draw, graphics_.get(), arguments);
    if (!error_) inner_->drawIndirect(arguments, offset);
}

void ValidationCommandList::dispatch(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    run(RecordedWork::Kind::Dispatch, compute_.get(), nullptr);
    if (!error_) inner_->dispatch(x, y, z);
}

void ValidationCommandList::dispatchIndirect(const BufferPtr& arguments, std::uint64_t offset) {
    run(RecordedWork::Kind::Dispatch, compute_.get(), arguments);
    if (!error_) inner_->dispatchIndirect(arguments, offset);
}

void ValidationCommandList::updateBuffer(const BufferPtr& target, std::uint64_t offset,
                                         std::span<const std::byte> bytes) {
    if (target) {
        RecordedWork work{RecordedWork::Kind::Update, {}, {}, {}, {}};
        use(work, {target, describe(target), true});
        record_.push_back(std::move(work));
    }
    if (!error_) inner_->updateBuffer(target, offset, bytes);
}

void ValidationCommandList::noteCopy(const Used& source, const BufferPtr& target) {
    RecordedWork work{RecordedWork::Kind::Copy, {}, {}, {}, {}};
    use(work, source);
    use(work, {target, describe(target), true});
    filled_.push_back(target);
    record_.push_back(std::move(work));
}

void ValidationCommandList::copyBuffer(const BufferPtr& source, std::uint64_t sourceOffset,
                                       const BufferPtr& target, std::uint64_t targetOffset,
                                       std::uint64_t size) {
    if (source && target) noteCopy({source, describe(source)}, target);
    if (!error_) inner_->copyBuffer(source, sourceOffset, target, targetOffset, size);
}

void ValidationCommandList::copyTextureToBuffer(const TexturePtr& source, const BufferPtr& target,
                                                std::uint64_t targetOffset) {
    if (source && target) noteCopy({source, describe(source)}, target);
    if (!error_) inner_->copyTextureToBuffer(source, target, targetOffset);
}

void ValidationCommandList::commit(ContentStates& contents, const SubmissionPtr& submission) const {
    for (const auto& resource : written_) {
        const auto known = contents.find(resource);
        if (known != contents.end()) known->second.written = true;
    }
    for (const auto& resource : filled_) {
        const auto known = contents.find(resource);
        if (known != contents.end()) known->second.filledBy = submission;
    }
}

}  // namespace hairloom::gpu
