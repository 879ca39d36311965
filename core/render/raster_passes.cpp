// SPDX-License-Identifier: GPL-3.0-or-later
// Frames by kernels: what is in front in each sample, then its light, then their mean.
#include <algorithm>
#include <bit>
#include <cmath>

#include "core/render/passes.h"

namespace hairloom::render {
namespace {

using gpu::Binding;

constexpr std::uint32_t kRowGroups = 32768;

/// Of a pixel's samples from its middle: Direct3D's standard patterns, in sixteenths of a pixel.
std::span<const std::array<int, 2>> samplePattern(std::uint32_t samples) {
    static constexpr std::array<std::array<int, 2>, 1> kOne{{{0, 0}}};
    static constexpr std::array<std::array<int, 2>, 2> kTwo{{{4, 4}, {-4, -4}}};
    static constexpr std::array<std::array<int, 2>, 4> kFour{{{-2, -6}, {6, -2}, {-6, 2}, {2, 6}}};
    static constexpr std::array<std::array<int, 2>, 8> kEight{
        {{1, -3}, {-1, 3}, {5, 1}, {-3, -5}, {-5, 5}, {-7, -1}, {3, 7}, {7, -7}}};
    switch (samples) {
        case 2:
            return kTwo;
        case 4:
            return kFour;
        case 8:
            return kEight;
        default:
            return kOne;
    }
}

/// Hair is kept as each pixel's nearest fragments.
bool sorts(const RendererState& state) {
    return state.plan.has(BufferId::fragmentDepths);
}

shaders::RasterConstants frameConstants(const RendererState& state, std::uint32_t phase) {
    const std::uint32_t width = state.options.width;
    shaders::RasterConstants c{};
    c.window = {0, 0, static_cast<float>(width), static_cast<float>(state.options.height)};
    c.bufferWidth = width;
    c.phase = phase;
    c.samples = state.samples;
    c.slices = 1;
    c.sorts = sorts(state) ? 1 : 0;
    const auto pattern = samplePattern(state.samples);
    int reach = 0;
    for (std::size_t i = 0; i < pattern.size(); ++i) {
        const auto [x, y] = pattern[i];
        reach = std::max({reach, std::abs(x), std::abs(y)});
        shaders::float4& two = c.samplePositions[i / 2];
        (i % 2 == 0 ? two.x : two.z) = static_cast<float>(x) / 16;
        (i % 2 == 0 ? two.y : two.w) = static_cast<float>(y) / 16;
    }
    c.sampleReach = static_cast<float>(reach) / 16;
    return c;
}

void dispatchMeshes(gpu::CommandList& list, RendererState& state, const Mat4f& clipFromWorld,
                    std::uint32_t phase) {
    list.setPipeline(state.pipelines.compute("mesh_raster.comp"));
    bindShadows(list, state);
    list.setConstants(0, gpu::bytesOf(lightsOfFrame(state)));
    bind(list, {Binding::read(4, state.orPlaceholder(BufferId::fragmentCover))});
    const shaders::RasterConstants raster = frameConstants(state, phase);
    for (const MeshOnDevice& mesh : state.scene.meshes) {
        if (mesh.indices.empty()) continue;
        list.setConstants(1, gpu::bytesOf(meshConstants(clipFromWorld, mesh.matte)));
        bind(list, {Binding::read(1, mesh.drawnNormals())});
        dispatchTriangles(list, state, mesh, raster);
    }
}

void dispatchPhase(gpu::CommandList& list, RendererState& state, const Mat4f& clipFromWorld,
                   std::uint32_t number, std::uint32_t phase) {
    const Targets& t = state.targets;
    bind(list, {Binding::write(0, t[BufferId::nearest]), Binding::write(1, t[BufferId::light])});
    if (state.scene.triangles() > 0) dispatchMeshes(list, state, clipFromWorld, phase);
    if (state.scene.batches.empty()) return;
    shaders::RasterConstants raster = frameConstants(state, phase);
    if (sorts(state)) {
        raster.sampleReach = 0.5f;  // of the square that cover is counted in
        list.setPipeline(state.pipelines.compute("strand_sorted.comp"));
        bind(list,
             {Binding::read(2, t[BufferId::nearest]), Binding::write(0, t[BufferId::fragmentDepths]),
              Binding::write(1, t[BufferId::fragmentLight]), Binding::write(2, t[BufferId::fragmentCover])});
    } else {
        list.setPipeline(state.pipelines.compute("strand_raster.comp"));
    }
    list.setConstants(0, gpu::bytesOf(viewConstants(state, clipFromWorld, number)));
    dispatchStrands(list, state, raster);
}

void recordResolve(gpu::CommandList& list, RendererState& state, std::uint32_t number) {
    const std::uint32_t pixels = state.options.width * state.options.height;
    const Targets& t = state.targets;
    const Rows rows(pixels);
    shaders::ResolveConstants constants{};
    constants.pixels = pixels;
    constants.rowThreads = rows.threads();
    constants.samples = state.samples;
    constants.sumBegins = number == 0 || state.options.temporal ? 1 : 0;
    constants.background =
        state.options.transparentBackground ? shaders::float4{0, 0, 0, 0} : toShader(state.background, 1);
    list.beginPass({passName(Pass::accumulate), {}, {}});
    list.setPipeline(state.pipelines.compute(sorts(state) ? "resolve_sorted.comp" : "resolve.comp"));
    list.setConstants(0, gpu::bytesOf(constants));
    if (sorts(state)) {
        bind(list,
             {Binding::read(2, t[BufferId::fragmentDepths]), Binding::read(3, t[BufferId::fragmentLight]),
              Binding::read(4, t[BufferId::fragmentCover])});
    }
    bind(list, {Binding::read(0, t[BufferId::nearest]), Binding::read(1, t[BufferId::light]),
                Binding::write(0, state.frames())});
    list.dispatch(rows.groups, rows.rows);
    list.endPass();
}

}  // namespace

Rows::Rows(std::uint64_t count) {
    const auto all = static_cast<std::uint32_t>((count + HAIRLOOM_LIST_GROUP - 1) / HAIRLOOM_LIST_GROUP);
    groups = std::clamp(all, 1u, kRowGroups);
    rows = std::max((all + groups - 1) / groups, 1u);
}

std::uint32_t Rows::threads() const {
    return groups * HAIRLOOM_LIST_GROUP;
}

void fill(gpu::CommandList& list, RendererState& state, BufferId buffer, std::uint32_t value) {
    const auto words = static_cast<std::uint32_t>(state.targets[buffer]->desc().size / 4);
    const Rows rows(words);
    shaders::FillConstants constants{};
    constants.value = value;
    constants.elements = words;
    constants.rowThreads = rows.threads();
    list.setPipeline(state.pipelines.compute("fill.comp"));
    list.setConstants(0, gpu::bytesOf(constants));
    bind(list, {Binding::write(0, state.targets[buffer])});
    list.dispatch(rows.groups, rows.rows);
}

void dispatchStrands(gpu::CommandList& list, const RendererState& state, shaders::RasterConstants raster,
                     float share) {
    for (const DrawBatch& batch : state.scene.batches) {
        const float wanted = std::ceil(share * static_cast<float>(batch.strandCount(state.detail)));
        const std::uint32_t points =
            batch.curvePoints(static_cast<std::uint32_t>(wanted), state.detail.subdivisions);
        const Rows rows(points);
        raster.count = points;
        raster.rowLength = rows.threads();
        list.setConstants(2, gpu::bytesOf(raster));
        bind(list, {Binding::read(0, batch.curve), Binding::read(1, state.colourOf(batch)),
                    Binding::read(5, state.acrossOf(batch))});
        list.dispatch(rows.groups, rows.rows);
    }
}

void dispatchTriangles(gpu::CommandList& list, const RendererState& state, const MeshOnDevice& mesh,
                       shaders::RasterConstants raster) {
    // So many groups that few large triangles keep a device busy as well.
    constexpr std::uint32_t kWantedGroups = 1u << 15u;
    constexpr std::uint32_t kMaxSlices = 64;
    const auto triangles = static_cast<std::uint32_t>(mesh.indices.size() / 3);
    raster.count = triangles;
    raster.rowLength = std::min(triangles, kRowGroups);
    raster.slices = state.onCpu ? 1 : std::clamp(kWantedGroups / triangles, 1u, kMaxSlices);
    list.setConstants(2, gpu::bytesOf(raster));
    bind(list, {Binding::read(0, mesh.drawnPositions()), Binding::read(2, mesh.indexBuffer),
                Binding::read(3, mesh.albedo)});
    list.dispatch(raster.rowLength, (triangles + raster.rowLength - 1) / raster.rowLength, raster.slices);
}

void recordRasterised(gpu::CommandList& list, RendererState& state, const Mat4f& clipFromWorld,
                      std::uint32_t number) {
    list.beginPass({passName(Pass::nearest), {}, {}});
    fill(list, state, BufferId::nearest, std::bit_cast<std::uint32_t>(1.0f));
    fill(list, state, BufferId::light, 0);
    if (sorts(state)) {
        fill(list, state, BufferId::fragmentDepths, std::bit_cast<std::uint32_t>(1.0f));
        fill(list, state, BufferId::fragmentLight, 0);
        fill(list, state, BufferId::fragmentCover, 0);
    }
    dispatchPhase(list, state, clipFromWorld, number, HAIRLOOM_PHASE_NEAREST);
    list.endPass();
    list.beginPass({passName(Pass::draw), {}, {}});
    dispatchPhase(list, state, clipFromWorld, number, HAIRLOOM_PHASE_LIGHT);
    list.endPass();
    recordResolve(list, state, number);
}

}  // namespace hairloom::render
