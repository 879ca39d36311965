// SPDX-License-Identifier: GPL-3.0-or-later
// From light to a picture: exposure, tone curve, and marks over it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/render/display_table.h"
#include "core/render/passes.h"
#include "shaders/shared/display_types.h"

namespace hairloom::render {
namespace {

using gpu::Binding;

constexpr std::uint64_t kMinOverlayVertices = 256;
constexpr float kBlurReach = 3;  // standard deviations that a Gaussian is cut off at

/// The device turns linear values into sRGB itself when it writes into this format.
bool encodesItself(gpu::Format format) {
    return format == gpu::Format::Rgba8UnormSrgb;
}

std::uint32_t verticesPerShape(OverlayShape shape) {
    return 1 + static_cast<std::uint32_t>(shape);
}

/// Corners that the shader makes of a batch: six for the square around a point or a line.
std::uint32_t corners(const OverlayBatch& batch) {
    const auto count = static_cast<std::uint32_t>(batch.vertices.size());
    return batch.shape == OverlayShape::triangles ? count : count / verticesPerShape(batch.shape) * 6;
}

/// Marks may lie in front of and behind all that is drawn.
Mat4f overlayMatrix(const RendererState& state) {
    Box3f box = state.bounds();
    box.extend(state.overlay.bounds_ws);
    return cameraMatrix(state, box);
}

void drawOverlay(gpu::CommandList& list, RendererState& state, gpu::Format format, bool onTop) {
    GraphicsNeeds needs{
        .vertex = "overlay.vert", .pixel = "overlay.frag", .colour = format, .blend = Blend::over};
    needs.depthTest = !onTop;
    list.setPipeline(state.pipelines.graphics(needs));
    bind(list, {Binding::read(0, state.overlay.vertices)});
    shaders::OverlayConstants constants{};
    constants.clipFromWorld = toShader(overlayMatrix(state));
    constants.width = static_cast<float>(state.options.width);
    constants.height = static_cast<float>(state.options.height);
    constants.keepsSrgb = encodesItself(format) ? 0.0f : 1.0f;
    std::uint32_t first = 0;
    for (const OverlayBatch& batch : state.overlay.overlay.batches) {
        if (batch.onTop == onTop && !batch.vertices.empty()) {
            constants.shape = static_cast<std::uint32_t>(batch.shape);
            constants.firstVertex = first;
            constants.markRadius = 0.5f * batch.size;
            list.setConstants(0, gpu::bytesOf(constants));
            list.draw(corners(batch));
        }
        first += static_cast<std::uint32_t>(batch.vertices.size());
    }
}

void drawByToneCurve(gpu::CommandList& list, RendererState& state, std::uint32_t frames, gpu::Format format) {
    list.setPipeline(
        state.pipelines.graphics({.vertex = "fullscreen.vert", .pixel = "tone_map.frag", .colour = format}));
    shaders::ToneConstants constants{};
    constants.exposure = state.options.exposure;
    constants.frameShare = 1 / static_cast<float>(frames);
    constants.encodesSrgb = encodesItself(format) ? 0.0f : 1.0f;
    constants.width = static_cast<float>(state.options.width);
    list.setConstants(0, gpu::bytesOf(constants));
    bind(list, {Binding::read(0, state.result())});
    list.draw(3);
}

void drawByTable(gpu::CommandList& list, RendererState& state, std::uint32_t frames, gpu::Format format) {
    list.setPipeline(state.pipelines.graphics(
        {.vertex = "fullscreen.vert", .pixel = "display_table.frag", .colour = format}));
    const DisplayTable& table = state.display.of->displayTable();
    shaders::DisplayConstants constants{};
    constants.alphaScale = 1 / static_cast<float>(frames);
    constants.scale = state.options.exposure * constants.alphaScale;
    constants.decodesSrgb = encodesItself(format) ? 1.0f : 0.0f;
    constants.width = static_cast<float>(state.options.width);
    constants.toe = table.toe;
    constants.stretch = static_cast<float>(table.side - 1) / std::log2(1 + table.toe * table.top);
    constants.top = table.top;
    constants.side = table.side;
    list.setConstants(0, gpu::bytesOf(constants));
    bind(list, {Binding::read(0, state.result()), Binding::read(1, state.display.codes)});
    list.draw(3);
}

void recordFilter(gpu::CommandList& list, RendererState& state, const gpu::TexturePtr& target) {
    list.beginPass({passName(Pass::filter), {{target, gpu::LoadOp::Discard, {}, {}}}, {}});
    list.setPipeline(state.pipelines.graphics(
        {.vertex = "fullscreen.vert", .pixel = "fxaa.frag", .colour = target->desc().format}));
    shaders::FilterConstants constants{};
    constants.width = static_cast<float>(state.options.width);
    constants.height = static_cast<float>(state.options.height);
    constants.texelWidth = 1 / constants.width;
    constants.texelHeight = 1 / constants.height;
    constants.keepsSrgb = encodesItself(target->desc().format) ? 0.0f : 1.0f;
    constants.longSearch = state.options.filter == PostFilter::fxaaHigh ? 1.0f : 0.0f;
    list.setConstants(0, gpu::bytesOf(constants));
    bind(list, {Binding::read(0, state.targets[TargetId::shown]), Binding::sample(0, state.linearFilter)});
    list.draw(3);
    list.endPass();
}

}  // namespace

Status check(const Overlay& overlay) {
    for (const OverlayBatch& batch : overlay.batches) {
        if (batch.vertices.size() % verticesPerShape(batch.shape) != 0) {
            return fail(fmt::format("{} vertices of marks", batch.vertices.size()),
                        fmt::format("{} each", verticesPerShape(batch.shape)));
        }
        if (!(batch.size >= 0 && batch.size <= 1000)) {
            return fail(fmt::format("marks of {} pixels", batch.size), "0 to 1000");
        }
        for (const OverlayVertex& vertex : batch.vertices) {
            if (!vertex.position_ws.head<3>().allFinite() || !vertex.colour.allFinite()) {
                return fail("a mark with a number that is not finite");
            }
        }
    }
    return {};
}

bool OverlayOnDevice::needsDepth() const {
    return std::ranges::any_of(overlay.batches, [](const OverlayBatch& b) { return !b.onTop; });
}

void recordShadowBlur(gpu::CommandList& list, RendererState& state) {
    const Targets& t = state.targets;
    const float deviation = state.options.shadowBlur;
    shaders::BlurConstants constants{};
    constants.width = state.options.width;
    constants.height = state.options.height;
    constants.reach = static_cast<std::uint32_t>(std::ceil(kBlurReach * deviation));
    constants.falloff = -0.5f / (deviation * deviation);
    list.beginPass({passName(Pass::shadowBlur), {}, {}});
    list.setPipeline(state.pipelines.compute("shadow_blur.comp"));
    for (const std::uint32_t direction : {0u, 1u}) {
        const bool alongRows = direction == 0;
        constants.alongColumns = direction;
        list.setConstants(0, gpu::bytesOf(constants));
        bind(list, {Binding::read(0, t[BufferId::sum]), Binding::read(1, t[BufferId::litSum]),
                    Binding::read(2, t[alongRows ? BufferId::litSum : BufferId::blurHalfway]),
                    Binding::write(0, t[alongRows ? BufferId::blurHalfway : BufferId::blurred])});
        list.dispatch(groupsFor(state.options.width, HAIRLOOM_TILE_GROUP),
                      groupsFor(state.options.height, HAIRLOOM_TILE_GROUP));
    }
    list.endPass();
}

void recordPresent(gpu::CommandList& list, RendererState& state, std::uint32_t frames,
                   const gpu::TexturePtr& target) {
    const bool filter = state.plan.runs(Pass::filter);
    const gpu::TexturePtr& shown = filter ? state.targets[TargetId::shown] : target;
    list.beginPass({passName(Pass::toneMap), {{shown, gpu::LoadOp::Discard, {}, {}}}, {}});
    if (state.options.toDisplay != nullptr) {
        drawByTable(list, state, frames, shown->desc().format);
    } else {
        drawByToneCurve(list, state, frames, shown->desc().format);
    }
    list.endPass();
    if (filter) recordFilter(list, state, target);
}

Status prepareDisplay(gpu::Device& device, RendererState& state) {
    DisplayOnDevice& display = state.display;
    if (display.of == state.options.toDisplay) return {};
    if (state.options.toDisplay == nullptr) {
        display = {};
        return {};
    }
    const DisplayTable& table = state.options.toDisplay->displayTable();
    const auto codes = std::as_bytes(std::span(table.codes));
    gpu::BufferDesc desc;
    desc.name = "view of the colour config";
    desc.elementBytes = sizeof(table.codes[0]);
    desc.size = codes.size();
    auto buffer = device.createBuffer(desc, codes);
    if (!buffer) return tl::unexpected(buffer.error());
    display = {state.options.toDisplay, std::move(*buffer)};
    return {};
}

Status prepareOverlay(gpu::Device& device, gpu::CommandList& list, OverlayOnDevice& overlay) {
    if (!overlay.waits) return {};
    std::uint64_t count = 0;
    for (const OverlayBatch& batch : overlay.overlay.batches) count += batch.vertices.size();
    const std::uint64_t room =
        overlay.vertices == nullptr ? 0 : overlay.vertices->desc().size / sizeof(OverlayVertex);
    if (count > room) {
        gpu::BufferDesc desc;
        desc.name = "overlay";
        desc.elementBytes = sizeof(OverlayVertex);
        desc.size = std::max({count, kMinOverlayVertices, 2 * room}) * sizeof(OverlayVertex);
        auto buffer = device.createBuffer(desc);
        if (!buffer) return tl::unexpected(buffer.error());
        overlay.vertices = std::move(*buffer);
    }
    std::uint64_t offset = 0;
    for (const OverlayBatch& batch : overlay.overlay.batches) {
        if (batch.vertices.empty()) continue;
        const auto bytes = std::as_bytes(std::span(batch.vertices));
        list.updateBuffer(overlay.vertices, offset, bytes);
        offset += bytes.size();
    }
    overlay.waits = false;
    return {};
}

void recordOverlay(gpu::CommandList& list, RendererState& state, const gpu::TexturePtr& target) {
    const gpu::Format format = target->desc().format;
    if (state.plan.runs(Pass::overlay)) {
        list.beginPass({passName(Pass::overlayDepth),
                        {},
                        {state.targets[TargetId::overlayDepth], gpu::LoadOp::Clear, 1}});
        list.setPipeline(state.pipelines.graphics(kMeshDepth));
        shaders::MeshConstants constants{};
        constants.clipFromWorld = toShader(overlayMatrix(state));
        list.setConstants(1, gpu::bytesOf(constants));
        drawMeshes(list, state);
        list.endPass();
        list.beginPass({passName(Pass::overlay),
                        {{target, gpu::LoadOp::Load, {}, {}}},
                        {state.targets[TargetId::overlayDepth], gpu::LoadOp::Load, 1}});
        drawOverlay(list, state, format, false);
        list.endPass();
    }
    if (state.plan.runs(Pass::overlayOnTop)) {
        list.beginPass({passName(Pass::overlayOnTop), {{target, gpu::LoadOp::Load, {}, {}}}, {}});
        drawOverlay(list, state, format, true);
        list.endPass();
    }
}

}  // namespace hairloom::render
