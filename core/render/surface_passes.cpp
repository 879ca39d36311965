// SPDX-License-Identifier: GPL-3.0-or-later
// What is nearest in the middle of each pixel: depth, strand, way since a frame ago, albedo.
#include <algorithm>

#include "core/render/passes.h"

namespace hairloom::render {
namespace {

using gpu::Binding;

// Of what moves more frames would trail, and fragments that are sorted have no noise that needs as many; what
// rests becomes as smooth as a still picture.
constexpr float kFramesMoving = 16, kFramesSorted = 3, kFramesStill = 64;

/// Metres along the view of a place (x, y, z, 1).
shaders::float4 forwardOf(const Camera& camera) {
    const Vec3f forward_ws = (camera.target_ws - camera.eye_ws).normalized();
    return toShader(forward_ws, -forward_ws.dot(camera.eye_ws));
}

shaders::RasterConstants everyPixel(const RendererState& state) {
    shaders::RasterConstants raster{};
    const std::uint32_t width = state.options.width, height = state.options.height;
    const Rows rows(std::uint64_t{width} * height);
    raster.window = {0, 0, static_cast<float>(width), static_cast<float>(height)};
    raster.bufferWidth = width;
    raster.count = width * height;
    raster.rowLength = rows.threads();
    raster.samples = 1;
    return raster;
}

void recordAlbedo(gpu::CommandList& list, RendererState& state) {
    for (const DrawBatch& batch : state.scene.batches) {
        const StrandShading& material = state.scene.materialOf(batch).shading;
        list.setPipeline(
            state.pipelines.compute(material.look ? "hair_albedo_look.comp" : "hair_albedo.comp"));
        auto constants = shadeConstants(state, material);
        if (material.fibre.model != ShadingModel::kajiya && !material.tubes)
            constants.albedo = toShader(material.fibreColour, 0);
        dispatchCurvePoints(list, state, batch, constants, batch.albedo);
    }
}

class SurfaceRecorder {
  public:
    SurfaceRecorder(gpu::CommandList& list, RendererState& state) : list_(list), state_(state) {
        const Mat4f clipFromWorld = cameraMatrix(state, state.bounds());
        clipFromWorld_ = clipFromWorld;
        constants_.clipFromWorld = toShader(clipFromWorld);
        constants_.pastClipFromWorld =
            state.pastCamera ? toShader(pastCameraMatrix(state)) : constants_.clipFromWorld;
        constants_.forward_ws = forwardOf(state.camera);
        constants_.pastForward_ws = forwardOf(state.pastCamera.value_or(state.camera));
        raster_ = everyPixel(state);
    }

    void phase(std::uint32_t number) {
        raster_.phase = number;
        constants_.firstItem = 0;
        if (state_.scene.triangles() > 0) meshes();
        if (!state_.scene.batches.empty()) strands();
    }

  private:
    void meshes() {
        list_.setPipeline(state_.pipelines.compute("mesh_surface.comp"));
        for (const MeshOnDevice& mesh : state_.scene.meshes) {
            if (mesh.indices.empty()) continue;
            constants_.pastStrands = mesh.hasPast ? 1 : 0;
            setConstants();
            list_.setConstants(1, gpu::bytesOf(meshConstants(clipFromWorld_, mesh.matte)));
            bind(list_, {Binding::read(1, mesh.hasPast ? mesh.past : mesh.drawnPositions())});
            dispatchTriangles(list_, state_, mesh, raster_);
            constants_.firstItem += static_cast<std::uint32_t>(mesh.indices.size() / 3);
        }
    }

    void strands() {
        list_.setPipeline(state_.pipelines.compute("strand_surface.comp"));
        list_.setConstants(0, gpu::bytesOf(viewConstants(state_, clipFromWorld_, 0)));
        const HairDetail& detail = state_.detail;
        for (const DrawBatch& batch : state_.scene.batches) {
            const std::uint32_t points = batch.curvePoints(batch.strandCount(detail), detail.subdivisions);
            const bool known = batch.pastSubdivisions == detail.subdivisions;
            constants_.pastStrands = known ? batch.pastStrands : 0;
            constants_.firstStrand = state_.scene.strandsBefore(batch.group);
            setConstants();
            bind(list_,
                 {Binding::read(0, batch.curve), Binding::read(1, batch.albedo),
                  Binding::read(2, batch.headers), Binding::read(3, known ? batch.past : batch.curve)});
            const Rows rows(points);
            shaders::RasterConstants raster = raster_;
            raster.count = points;
            raster.rowLength = rows.threads();
            list_.setConstants(2, gpu::bytesOf(raster));
            list_.dispatch(rows.groups, rows.rows);
            constants_.firstItem += points;
        }
    }

    void setConstants() {
        const Targets& t = state_.targets;
        list_.setConstants(3, gpu::bytesOf(constants_));
        bind(list_, {Binding::write(0, t[BufferId::surfaceNearest]),
                     Binding::write(1, t[BufferId::surfaceItem]), Binding::write(2, t[BufferId::surface])});
    }

    gpu::CommandList& list_;
    RendererState& state_;
    Mat4f clipFromWorld_;
    shaders::SurfaceConstants constants_{};
    shaders::RasterConstants raster_{};
};

}  // namespace

void recordSurface(gpu::CommandList& list, RendererState& state) {
    const Targets& t = state.targets;
    list.beginPass({passName(Pass::surface), {}, {}});
    recordAlbedo(list, state);
    const shaders::RasterConstants raster = everyPixel(state);
    list.setPipeline(state.pipelines.compute("surface_begin.comp"));
    list.setConstants(2, gpu::bytesOf(raster));
    bind(list, {Binding::write(0, t[BufferId::surfaceNearest]), Binding::write(1, t[BufferId::surfaceItem]),
                Binding::write(2, t[BufferId::surface])});
    const Rows rows(raster.count);
    list.dispatch(rows.groups, rows.rows);
    SurfaceRecorder recorder(list, state);
    for (const std::uint32_t phase : {HAIRLOOM_PHASE_NEAREST, HAIRLOOM_PHASE_ITEM, HAIRLOOM_PHASE_TELL})
        recorder.phase(phase);
    list.endPass();
}

void recordTemporal(gpu::CommandList& list, RendererState& state, bool moves) {
    const Targets& t = state.targets;
    const bool turn = state.temporal.turn;
    shaders::TemporalConstants constants{};
    constants.width = state.options.width;
    constants.height = state.options.height;
    constants.hasPast = state.temporal.frames > 0 ? 1 : 0;
    const bool sorted = state.options.transparency == Transparency::sorted;
    constants.most = !moves ? kFramesStill : sorted ? kFramesSorted : kFramesMoving;
    constants.moves = moves ? 1 : 0;
    list.beginPass({passName(Pass::temporal), {}, {}});
    list.setPipeline(state.pipelines.compute("temporal.comp"));
    list.setConstants(0, gpu::bytesOf(constants));
    // Before the first frame there is nothing to read; its sum has elements of the same size.
    const bool past = state.temporal.frames > 0;
    const auto before = [&](BufferId one, BufferId other) {
        return past ? t[turn ? one : other] : t[BufferId::sum];
    };
    bind(list, {Binding::read(0, t[BufferId::sum]), Binding::read(1, t[BufferId::surface]),
                Binding::read(2, before(BufferId::history, BufferId::otherHistory)),
                Binding::read(3, before(BufferId::historyPixels, BufferId::otherHistoryPixels)),
                Binding::write(0, t[turn ? BufferId::otherHistory : BufferId::history]),
                Binding::write(1, t[turn ? BufferId::otherHistoryPixels : BufferId::historyPixels])});
    list.dispatch(groupsFor(state.options.width, HAIRLOOM_TILE_GROUP),
                  groupsFor(state.options.height, HAIRLOOM_TILE_GROUP));
    list.endPass();
    state.temporal.turn = !turn;
    ++state.temporal.frames;
}

void recordPast(gpu::CommandList& list, RendererState& state) {
    for (DrawBatch& batch : state.scene.batches) {
        batch.pastSubdivisions = state.detail.subdivisions;
        batch.pastStrands = batch.strandCount(state.detail);
        const std::uint64_t points = batch.curvePoints(batch.pastStrands, batch.pastSubdivisions);
        list.copyBuffer(batch.curve, 0, batch.past, 0, points * sizeof(shaders::CurvePoint));
    }
    for (MeshOnDevice& mesh : state.scene.meshes) {
        if (mesh.past == nullptr) continue;
        list.copyBuffer(mesh.drawnPositions(), 0, mesh.past, 0, mesh.past->desc().size);
        mesh.hasPast = true;
    }
    state.pastCamera = state.camera;
}

}  // namespace hairloom::render
