// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/software/command_list.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "core/base/parallel.h"
#include "core/software/marks.h"
#include "core/software/memory.h"
#include "core/software/mesh_depth.h"

namespace hairloom::software {
namespace {

/// Groups of a dispatch that one thread takes at once.
constexpr std::size_t kGroupsAtOnce = 16;
constexpr std::size_t kRowsAtOnce = 16;

double secondsNow() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

HostBuffer& of(const gpu::BufferPtr& buffer) {
    return static_cast<HostBuffer&>(*buffer);
}
HostTexture& of(const gpu::TexturePtr& texture) {
    return static_cast<HostTexture&>(*texture);
}

/// The bytes that a binding has of its buffer.
std::span<std::byte> bytesOfBinding(const gpu::Binding& binding) {
    const std::span<std::byte> all = of(binding.buffer).bytes();
    const auto offset = static_cast<std::size_t>(binding.offset);
    return binding.size == 0 ? all.subspan(offset)
                             : all.subspan(offset, static_cast<std::size_t>(binding.size));
}

template <class T>
std::span<const T> elementsOf(const gpu::Binding& binding) {
    const std::span<const std::byte> bytes = bytesOfBinding(binding);
    return {reinterpret_cast<const T*>(bytes.data()), bytes.size() / sizeof(T)};
}

template <class T>
std::span<T> elementsOf(const gpu::BufferPtr& buffer) {
    const std::span<std::byte> bytes = of(buffer).bytes();
    return {reinterpret_cast<T*>(bytes.data()), bytes.size() / sizeof(T)};
}

/// Does what was put off until somebody reads the buffer.
void settle(HostBuffer& buffer) {
    if (const auto shading = std::exchange(buffer.shading, nullptr)) shading->ensureAll();
    if (const auto sky = std::exchange(buffer.sky, nullptr)) sky->ensureAll();
}

void fillTexels(HostTexture& texture, const float* value) {
    for (std::uint32_t y = 0; y < texture.desc().height; ++y) {
        for (std::uint32_t x = 0; x < texture.desc().width; ++x) texture.write(x, y, value);
    }
}

}  // namespace

HostCommandList::~HostCommandList() {
    close();
}

void HostCommandList::close() {
    if (whenClosed_) std::exchange(whenClosed_, nullptr)();
}

Result<gpu::SubmissionPtr> HostCommandList::finish() {
    close();
    if (auto status = checkFinished(); !status) return tl::unexpected(status.error());
    return std::make_shared<HostSubmission>(std::move(times_));
}

/// Nothing is under way when a call returns.
void HostCommandList::keep(std::shared_ptr<const void> /*object*/) {}

void HostCommandList::recordPassBegin() {
    passBegan_ = secondsNow();
    for (const gpu::ColourTarget& target : passDesc().colour) {
        if (target.load == gpu::LoadOp::Clear) fillTexels(of(target.texture), target.clear.data());
    }
    const gpu::DepthTarget& depth = passDesc().depth;
    if (depth.texture && depth.load == gpu::LoadOp::Clear)
        std::ranges::fill(of(depth.texture).texels(), depth.clear);
}

void HostCommandList::recordPassEnd() {
    times_.push_back({passDesc().name, 1000 * (secondsNow() - passBegan_)});
}

Result<gpu::Binding> HostCommandList::stageConstants(std::uint32_t slot, std::span<const std::byte> bytes) {
    gpu::BufferDesc desc;
    desc.name = "constants";
    desc.size = bytes.size();
    desc.usage = gpu::Usage::Constant;
    auto buffer = HostBuffer::make(desc, bytes);
    if (!buffer) return tl::unexpected(buffer.error());
    return gpu::Binding::constants(slot, std::move(*buffer));
}

Registers HostCommandList::registersOf(std::span<const gpu::ShaderRegister> used, bool settles) const {
    Registers registers;
    for (const gpu::ShaderRegister& at : used) {
        const gpu::Binding* found = boundIfAny(at);
        if (found == nullptr) continue;
        const gpu::Binding& binding = *found;
        switch (at.kind) {
            case gpu::Binding::Kind::ConstantBuffer:
                registers.constants[at.slot] = bytesOfBinding(binding).data();
                break;
            case gpu::Binding::Kind::ShaderResource:
                if (binding.texture) {
                    const HostTexture& texture = of(binding.texture);
                    registers.textures[at.slot] = {texture.texels().data(),
                                                   static_cast<int>(texture.desc().width),
                                                   static_cast<int>(texture.desc().height)};
                } else {
                    if (settles) settle(of(binding.buffer));
                    registers.read[at.slot] = bytesOfBinding(binding).data();
                }
                break;
            case gpu::Binding::Kind::UnorderedAccess:
                registers.written[at.slot] = bytesOfBinding(binding).data();
                break;
            case gpu::Binding::Kind::Sampler:
                break;
        }
    }
    return registers;
}

void HostCommandList::drawMeshDepth(std::uint32_t vertices) {
    HostTexture& target = of(passDesc().depth.texture);
    const gpu::ScissorRect& part = scissor();
    const auto constants = elementsOf<float>(bound({gpu::Binding::Kind::ConstantBuffer, 1}));
    const auto positions = elementsOf<float>(bound({gpu::Binding::Kind::ShaderResource, 0}));
    const auto indices = elementsOf<std::uint32_t>(bound({gpu::Binding::Kind::ShaderResource, 2}));
    std::array<float, 16> clipFromWorld{};
    std::copy_n(constants.begin(), clipFromWorld.size(), clipFromWorld.begin());
    drawDepth({target.texels(), target.desc().width, part.x, part.y, part.width, part.height}, clipFromWorld,
              positions, indices.first(std::min<std::size_t>(vertices, indices.size())));
}

void HostCommandList::drawFullscreen(const KernelEntry& kernel) {
    const Registers registers =
        registersOf(static_cast<const HostGraphicsPipeline&>(graphics()).declared, true);
    HostTexture& target = of(passDesc().colour.front().texture);
    const std::uint32_t columns = target.desc().width;
    parallelFor(target.desc().height, kRowsAtOnce, [&](std::size_t begin, std::size_t end) {
        std::vector<float4> pixels(columns);
        for (auto y = static_cast<std::uint32_t>(begin); y < end; ++y) {
            kernel.fillRow(registers, y, columns, pixels.data());
            for (std::uint32_t x = 0; x < columns; ++x) target.write(x, y, &pixels[x].x);
        }
    });
}

void HostCommandList::drawMarks(std::uint32_t vertices) {
    HostTexture& target = of(passDesc().colour.front().texture);
    const gpu::TexturePtr& depth = passDesc().depth.texture;
    const std::span<const float> hides =
        depth ? std::span<const float>(of(depth).texels()) : std::span<const float>();
    software::drawMarks(target, hides, constantsAt<shaders::OverlayConstants>(0),
                        elementsOf<const shaders::OverlayVertex>(read(0)), vertices);
}

bool HostCommandList::leaves() {
    if (!isAsked(stop_)) return false;
    wrong(std::string(kDropped));
    return true;
}

void HostCommandList::recordDraw(const gpu::DrawArguments& arguments) {
    const auto& pipeline = static_cast<const HostGraphicsPipeline&>(graphics());
    if (leaves()) return;
    const auto* direct = std::get_if<gpu::DirectDraw>(&arguments);
    if (direct == nullptr) return wrong("the software renderer draws neither with indices nor indirectly");
    switch (pipeline.draw) {
        case HostDraw::meshDepth:
            return drawMeshDepth(direct->vertices);
        case HostDraw::fullscreen:
            return drawFullscreen(*pipeline.kernel);
        case HostDraw::marks:
            return drawMarks(direct->vertices);
    }
}

const gpu::BufferPtr& HostCommandList::read(std::uint32_t slot) const {
    return bound({gpu::Binding::Kind::ShaderResource, slot}).buffer;
}

const gpu::BufferPtr& HostCommandList::written(std::uint32_t slot) const {
    return bound({gpu::Binding::Kind::UnorderedAccess, slot}).buffer;
}

template <class T>
const T& HostCommandList::constantsAt(std::uint32_t slot) const {
    return *elementsOf<const T>(bound({gpu::Binding::Kind::ConstantBuffer, slot})).data();
}

/// The hair that a kernel which rasterises it has bound.
RibbonBatch HostCommandList::batchOf() const {
    return {
        elementsOf<const shaders::CurvePoint>(read(0)).first(constantsAt<shaders::RasterConstants>(2).count),
        constantsAt<shaders::ViewConstants>(0)};
}

DeferredDispatch HostCommandList::deferred(const KernelEntry& kernel) const {
    const auto& pipeline = static_cast<const HostComputePipeline&>(compute());
    DeferredDispatch work{&kernel, registersOf(pipeline.declared, false), {}, stop_};
    for (const gpu::ShaderRegister& at : pipeline.declared) {
        // What it writes keeps the work, not the other way round.
        const gpu::Binding* found = boundIfAny(at);
        if (found != nullptr && at.kind != gpu::Binding::Kind::UnorderedAccess) work.kept.push_back(*found);
    }
    return work;
}

bool HostCommandList::deferSky(const KernelEntry& kernel) {
    of(written(0)).sky =
        std::make_shared<LazySky>(deferred(kernel), constantsAt<shaders::ShadeConstants>(0).count);
    return true;
}

bool HostCommandList::deferShading(const KernelEntry& kernel) {
    if (kernel.name.starts_with("shade_across")) {
        of(written(0)).shading =
            std::make_shared<LazyShading>(deferred(kernel), nullptr, of(read(4)).shading);
        return true;
    }
    of(written(0)).shading = std::make_shared<LazyShading>(deferred(kernel), of(read(3)).sky);
    return true;
}

void HostCommandList::dispatchSorted() {
    const auto& raster = constantsAt<shaders::RasterConstants>(2);
    if (raster.phase == HAIRLOOM_PHASE_LIGHT) {
        hair_.colours.push_back(read(1));
        hair_.across.push_back(read(5));
        return;
    }
    if (hair_.sorted == nullptr || hair_.sorted->found()) {
        hair_ = {};
        hair_.sorted = std::make_unique<SortedHair>(raster, stop_);
    }
    hair_.nearest = read(2);
    hair_.cover = written(2);
    hair_.curves.push_back(read(0));
    hair_.sorted->add(batchOf());
}

void HostCommandList::resolveSorted() {
    std::vector<HairLight> lights;
    for (std::size_t i = 0; i < hair_.colours.size(); ++i) {
        const gpu::BufferPtr& shown = hair_.sorted->changesAcross(i) ? hair_.across[i] : hair_.colours[i];
        HostBuffer& buffer = of(shown);
        if (buffer.shading != nullptr) buffer.shading->ensure(hair_.sorted->shownPoints(i));
        lights.push_back(
            {elementsOf<const float4>(hair_.colours[i]), elementsOf<const std::uint32_t>(hair_.across[i])});
    }
    // All of it or nothing joins the sum.
    if (leaves()) return;
    hair_.sorted->resolve(constantsAt<shaders::ResolveConstants>(0), elementsOf<const std::uint32_t>(read(0)),
                          elementsOf<const std::uint32_t>(read(1)), lights, elementsOf<float4>(written(0)));
    hair_ = {};
}

bool HostCommandList::dispatchApart(const KernelEntry& kernel) {
    if (kernel.name.starts_with("shade") || kernel.name == "curve.comp") maps_.forget();
    if (kernel.name == "strand_sorted.comp") return dispatchSorted(), true;
    if (hair_.sorted != nullptr && !hair_.sorted->found())
        hair_.sorted->find(elementsOf<const std::uint32_t>(hair_.nearest),
                           elementsOf<std::uint32_t>(hair_.cover));
    if (kernel.name == "resolve_sorted.comp" && hair_.sorted != nullptr) return resolveSorted(), true;
    if (kernel.name == "light_first.comp") {
        maps_.drawFirstHair(batchOf(), constantsAt<shaders::RasterConstants>(2),
                            elementsOf<std::uint32_t>(written(0)));
        return true;
    }
    if (kernel.name == "light_layers.comp") {
        maps_.countLayers(batchOf(), constantsAt<shaders::RasterConstants>(2),
                          elementsOf<const std::uint32_t>(read(2)), elementsOf<std::uint32_t>(written(0)));
        return true;
    }
    if (kernel.name == "light_link.comp") {
        maps_.listFragments(batchOf(), constantsAt<shaders::RasterConstants>(2),
                            elementsOf<std::uint32_t>(written(0)), elementsOf<std::uint32_t>(written(1)),
                            elementsOf<std::uint32_t>(written(2)));
        return true;
    }
    if (kernel.name == "fill.comp") {
        std::ranges::fill(elementsOf<std::uint32_t>(written(0)),
                          constantsAt<shaders::FillConstants>(0).value);
        return true;
    }
    if (kernel.name == "sky_seen.comp") return deferSky(kernel);
    if (kernel.name.starts_with("shade")) return deferShading(kernel);
    return false;
}

void HostCommandList::recordDispatch(const gpu::DispatchArguments& arguments) {
    if (leaves()) return;
    const auto* counts = std::get_if<gpu::GroupCounts>(&arguments);
    if (counts == nullptr) return wrong("the software renderer dispatches nothing indirectly");
    const auto& pipeline = static_cast<const HostComputePipeline&>(compute());
    if (dispatchApart(*pipeline.kernel)) return;
    const Registers registers = registersOf(pipeline.declared, true);
    const std::array<std::uint32_t, 3> groups{counts->x, counts->y, counts->z};
    const std::size_t all = std::size_t{groups[0]} * groups[1] * groups[2];
    // What adds to the sum of frames adds all of a frame.
    const bool whole = pipeline.kernel->name.starts_with("resolve");
    parallelUntil(whole ? Stop() : stop_, all, kGroupsAtOnce, [&](std::size_t begin, std::size_t end) {
        pipeline.kernel->run(registers, groups, begin, end);
    });
}

void HostCommandList::recordUpdate(const gpu::BufferPtr& target, std::uint64_t offset,
                                   std::span<const std::byte> bytes) {
    std::ranges::copy(bytes, of(target).bytes().subspan(static_cast<std::size_t>(offset)).begin());
}

void HostCommandList::recordCopy(const gpu::BufferPlace& source, const gpu::BufferPlace& target,
                                 std::uint64_t size) {
    settle(of(source.buffer));
    const auto from = of(source.buffer).bytes().subspan(static_cast<std::size_t>(source.offset));
    std::ranges::copy(from.first(static_cast<std::size_t>(size)),
                      of(target.buffer).bytes().subspan(static_cast<std::size_t>(target.offset)).begin());
}

void HostCommandList::recordTextureCopy(const gpu::TexturePtr& source, const gpu::BufferPlace& target) {
    of(source).copyTo(of(target.buffer).bytes().subspan(static_cast<std::size_t>(target.offset)));
}

}  // namespace hairloom::software
