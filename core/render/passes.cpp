// SPDX-License-Identifier: GPL-3.0-or-later
// Frames: transforming and rasterising what is shaded already.
#include "core/render/passes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <vector>

namespace hairloom::render {
namespace {

using gpu::Binding;

// Software rasterisers corrupt geometry when one draw emits more than 65,536 vertices.
constexpr std::uint32_t kPatchesPerDrawOnCpu = 32;
constexpr float kDeviation = 0.05f;  // pixels, of a tessellated ribbon from its curve

/// One element of zeros, where there is none yet.
Status prepareBuffer(gpu::Device& device, const char* name, std::uint32_t elementBytes,
                     gpu::BufferPtr& buffer) {
    if (buffer != nullptr) return {};
    gpu::BufferDesc desc;
    desc.name = name;
    desc.size = desc.elementBytes = elementBytes;
    auto made = device.createBuffer(desc, std::vector<std::byte>(elementBytes));
    if (!made) return tl::unexpected(made.error());
    buffer = std::move(*made);
    return {};
}

/// Offsets of a frame in pixels, Gaussian, which makes the average a Gaussian filter (sigma 0.45).
std::array<float, 2> jitter(std::uint32_t number, const RenderOptions& options) {
    constexpr std::uint32_t kTemporalFrames = 64;
    if (options.temporal) number %= kTemporalFrames;
    if (!options.temporal && options.frames == 1) return {0, 0};
    // Fragments that are sorted cover a tent, whose variance is 1/6 of a pixel.
    const double sigma =
        options.transparency == Transparency::sorted ? std::sqrt(0.45 * 0.45 - 1.0 / 6) : 0.45;
    // The R2 sequence (Roberts 2018), then Box and Muller.
    const double n = number;
    const double u = std::fmod(0.5 + n * 0.7548776662466927, 1.0);
    const double v = std::fmod(0.5 + n * 0.5698402909980532, 1.0);
    const double radius = std::min(sigma * std::sqrt(-2 * std::log(std::max(u, 1e-3))), 1.5);
    const double angle = 2 * static_cast<double>(kPi) * v;
    return {static_cast<float>(radius * std::cos(angle)), static_cast<float>(radius * std::sin(angle))};
}

/// Metres in front of the eye at which a box begins and ends.
std::array<float, 2> distances(const Camera& camera, const Box3f& box) {
    const Mat4f view = viewMatrix(camera);
    float nearest = 1e30f;
    float farthest = 0.1f;
    for (int i = 0; i < 8 && !box.isEmpty(); ++i) {
        const float distance = -(view * box.corner(static_cast<Box3f::CornerType>(i)).homogeneous()).z();
        nearest = std::min(nearest, distance);
        farthest = std::max(farthest, distance);
    }
    return {nearest, farthest};
}

/// Metres that a pixel is wide at distance 1, or anywhere without perspective.
float pixelSpread(const Camera& camera, const RenderOptions& options) {
    if (camera.isOrthographic()) return camera.orthographicHeight / static_cast<float>(options.height);
    return 2 * std::tan(radians(camera.verticalFov) / 2) / static_cast<float>(options.height);
}

/// Where hair begins in front of the camera and how deep it is: metres, or clip space's without perspective.
std::array<float, 2> depthOfHair(const RendererState& state, const Mat4f& clipFromWorld) {
    const auto [nearest, farthest] = distances(state.camera, state.scene.hairBounds());
    if (!state.camera.isOrthographic()) return {std::max(nearest, 0.0f), farthest - std::max(nearest, 0.0f)};
    const Vec3f forward = (state.camera.target_ws - state.camera.eye_ws).normalized();
    const auto clipDepth = [&](float distance) {
        return (clipFromWorld * (state.camera.eye_ws + distance * forward).homogeneous()).z();
    };
    return {clipDepth(nearest), clipDepth(farthest) - clipDepth(nearest)};
}

GraphicsNeeds strandPipeline(const RendererState& state) {
    const bool blend = state.plan.runs(Pass::blend);
    GraphicsNeeds needs{.vertex = blend ? "strand_blend.vert" : "strand.vert",
                        .pixel = blend ? "strand_blend.frag" : "strand.frag",
                        .topology = gpu::Topology::TriangleStrip,
                        .colour = kColourFormat,
                        .depthTest = true,
                        .depthWrite = !blend,
                        .samples = state.samples};
    if (blend) {
        needs.secondColour = kColourFormat;
        needs.blend = Blend::weighedAndRest;
    }
    if (state.options.ribbons == Ribbons::tessellated) {
        needs.vertex = "strand_patch.vert";
        needs.hull = "strand_patch.tesc";
        needs.domain = blend ? "strand_patch_blend.tese" : "strand_patch.tese";
        needs.topology = gpu::Topology::PatchList;
    }
    return needs;
}

void drawPatches(gpu::CommandList& list, const RendererState& state) {
    shaders::PatchConstants constants{};
    constants.width = static_cast<float>(state.options.width);
    constants.height = static_cast<float>(state.options.height);
    constants.deviation = kDeviation;
    constants.subdivisions = state.detail.subdivisions;
    for (const DrawBatch& batch : state.scene.batches) {
        if (state.scene.materialOf(batch).shading.tubes) continue;
        bind(list, {Binding::read(0, batch.curve), Binding::read(1, state.colourOf(batch)),
                    Binding::read(2, batch.headers), Binding::read(3, batch.patches),
                    Binding::read(5, state.acrossOf(batch))});
        const std::uint32_t count = batch.patchesBefore[batch.strandCount(state.detail)];
        const std::uint32_t step = state.onCpu ? kPatchesPerDrawOnCpu : count;
        for (std::uint32_t first = 0; first < count; first += step) {
            constants.firstPatch = first;
            list.setConstants(2, gpu::bytesOf(constants));
            list.draw(std::min(step, count - first));
        }
    }
}

/// As strips of the curves' points.
void drawStrips(gpu::CommandList& list, const RendererState& state, const DrawBatch& batch) {
    const std::uint32_t subdivisions = state.detail.subdivisions;
    bind(list, {Binding::read(0, batch.curve), Binding::read(1, state.colourOf(batch)),
                Binding::read(5, state.acrossOf(batch))});
    list.setIndexBuffer(batch.indices.at(subdivisions));
    list.drawIndexed(batch.indexCount(batch.strandCount(state.detail), subdivisions));
}

void drawHair(gpu::CommandList& list, RendererState& state, const Mat4f& clipFromWorld,
              std::uint32_t number) {
    list.setPipeline(state.pipelines.graphics(strandPipeline(state)));
    list.setConstants(0, gpu::bytesOf(viewConstants(state, clipFromWorld, number)));
    if (state.options.ribbons == Ribbons::tessellated) {
        drawPatches(list, state);
    } else {
        for (const DrawBatch& batch : state.scene.batches) {
            if (!state.scene.materialOf(batch).shading.tubes) drawStrips(list, state, batch);
        }
    }
}

/// Strands that are round and have skin: opaque, and never thinner than a pixel.
void drawTubes(gpu::CommandList& list, RendererState& state, const Mat4f& clipFromWorld,
               std::uint32_t number) {
    if (!state.scene.hasTubes()) return;
    list.setPipeline(state.pipelines.graphics({.vertex = "tube.vert",
                                               .pixel = "tube.frag",
                                               .topology = gpu::Topology::TriangleStrip,
                                               .colour = kColourFormat,
                                               .depthTest = true,
                                               .depthWrite = true,
                                               .samples = state.samples}));
    bindShadows(list, state);
    list.setConstants(0, gpu::bytesOf(viewConstants(state, clipFromWorld, number)));
    for (const DrawBatch& batch : state.scene.batches) {
        const StrandShading& material = state.scene.materialOf(batch).shading;
        if (!material.tubes) continue;
        list.setConstants(1, gpu::bytesOf(shadeConstants(state, material)));
        drawStrips(list, state, batch);
    }
}

void drawHeads(gpu::CommandList& list, RendererState& state, const Mat4f& clipFromWorld) {
    list.setPipeline(state.pipelines.graphics({.vertex = "mesh.vert",
                                               .pixel = "mesh.frag",
                                               .colour = kColourFormat,
                                               .depthTest = true,
                                               .depthWrite = true,
                                               .samples = state.samples}));
    bindShadows(list, state);
    list.setConstants(0, gpu::bytesOf(lightsOfFrame(state)));
    for (const bool matte : {false, true}) {
        list.setConstants(1, gpu::bytesOf(meshConstants(clipFromWorld, matte)));
        drawMeshes(list, state, matte);
    }
}

/// Hair over the head in any order, onto what is drawn.
void recordBlend(gpu::CommandList& list, RendererState& state, const Mat4f& clipFromWorld,
                 std::uint32_t number) {
    const Targets& t = state.targets;
    gpu::PassDesc pass;
    pass.name = passName(Pass::blend);
    pass.colour = {
        {t[TargetId::blendSum], gpu::LoadOp::Clear, {0, 0, 0, 0}, t[TargetId::blendSumResolved]},
        {t[TargetId::blendRest], gpu::LoadOp::Clear, {1, 1, 1, 1}, t[TargetId::blendRestResolved]}};
    pass.depth = {t[TargetId::depth], gpu::LoadOp::Load, 1};
    list.beginPass(pass);
    drawHair(list, state, clipFromWorld, number);
    list.endPass();
    const bool many = state.samples > 1;
    list.beginPass({passName(Pass::composite), {{t.frame(), gpu::LoadOp::Load, {}, {}}}, {}});
    list.setPipeline(state.pipelines.graphics({.vertex = "fullscreen.vert",
                                               .pixel = "composite.frag",
                                               .colour = kColourFormat,
                                               .blend = Blend::over}));
    bind(list, {Binding::read(0, t[many ? TargetId::blendSumResolved : TargetId::blendSum]),
                Binding::read(1, t[many ? TargetId::blendRestResolved : TargetId::blendRest])});
    list.draw(3);
    list.endPass();
}

}  // namespace

Status preparePlaceholders(gpu::Device& device, RendererState& state) {
    if (state.placeholderTexture == nullptr) {
        gpu::TextureDesc desc;
        desc.name = "nothing";
        auto made = device.createTexture(desc, std::array<std::byte, 4>{});
        if (!made) return tl::unexpected(made.error());
        state.placeholderTexture = std::move(*made);
    }
    if (auto status = prepareBuffer(device, "no words", sizeof(std::uint32_t), state.placeholderBuffer);
        !status)
        return status;
    if (auto status = prepareBuffer(device, "no light grid", sizeof(shaders::float4), state.noColour);
        !status)
        return status;
    return prepareBuffer(device, "no sky", sizeof(shaders::SkyPoint), state.noSky);
}

shaders::ViewConstants viewConstants(const RendererState& state, const Mat4f& clipFromWorld,
                                     std::uint32_t number) {
    const auto [begin, depth] = depthOfHair(state, clipFromWorld);
    shaders::ViewConstants view{};
    view.clipFromWorld = toShader(clipFromWorld);
    view.eye_ws = eyeOf(state.camera);
    view.pixelSize = pixelSpread(state.camera, state.options);
    view.minWidth = 1;
    view.samples = state.samples;
    view.frame = number;
    view.hairBegins = begin;
    view.hairDepth = depth;
    view.across = !state.plan.runs(Pass::across)                  ? HAIRLOOM_ACROSS_NONE
                  : state.options.ribbons == Ribbons::tessellated ? HAIRLOOM_ACROSS_PATCHES
                                                                  : HAIRLOOM_ACROSS_PIECES;
    return view;
}

shaders::MeshConstants meshConstants(const Mat4f& clipFromWorld, bool matte) {
    shaders::MeshConstants constants{};
    constants.clipFromWorld = toShader(clipFromWorld);
    constants.wrap = matte ? 0.0f : 0.35f;
    constants.specular = matte ? 0.0f : 0.6f;
    constants.specularExponent = matte ? 1.0f : 28.0f;
    return constants;
}

void bind(gpu::CommandList& list, std::initializer_list<Binding> bindings) {
    list.bind(std::span<const Binding>(bindings.begin(), bindings.size()));
}

void bindShadows(gpu::CommandList& list, const RendererState& state) {
    bind(list, {Binding::read(8, state.orPlaceholder(TargetId::headDepth)),
                Binding::read(9, state.orPlaceholder(BufferId::firstHair)),
                Binding::read(10, state.orPlaceholder(BufferId::opacity)),
                Binding::read(18, state.orPlaceholder(TargetId::skyHead)),
                Binding::read(19, state.orPlaceholder(BufferId::skyLayers)),
                Binding::read(20, state.targets[BufferId::lightGrid] ? state.targets[BufferId::lightGrid]
                                                                     : state.noColour)});
    list.setConstants(3, gpu::bytesOf(state.sky));
}

void drawMeshes(gpu::CommandList& list, const RendererState& state, std::optional<bool> matte) {
    for (const MeshOnDevice& mesh : state.scene.meshes) {
        if (mesh.indices.empty() || (matte && *matte != mesh.matte)) continue;
        bind(list, {Binding::read(0, mesh.drawnPositions()), Binding::read(1, mesh.drawnNormals()),
                    Binding::read(2, mesh.indexBuffer), Binding::read(3, mesh.albedo)});
        list.draw(static_cast<std::uint32_t>(mesh.indices.size()));
    }
}

shaders::float4x4 toShader(const Mat4f& m) {
    shaders::float4x4 result;
    std::memcpy(result.m, m.data(), sizeof(result.m));
    return result;
}

shaders::float4 toShader(const Vec3f& v, float w) {
    return {v.x(), v.y(), v.z(), w};
}

shaders::float4 eyeOf(const Camera& camera) {
    if (!camera.isOrthographic()) return toShader(camera.eye_ws, 1);
    return toShader((camera.eye_ws - camera.target_ws).normalized(), 0);
}

Box3f RendererState::bounds() const {
    Box3f box = scene.meshBounds();
    box.extend(scene.hairBounds());
    return box;
}

HairDetail detailOf(const RendererState& state) {
    HairDetail detail;
    detail.subdivisions = state.options.subdivisions;
    const Box3f hair = state.scene.hairBounds();
    if (state.options.detail <= 0 || hair.isEmpty()) return detail;
    constexpr float kPixelsPerSegment = 2;
    constexpr float kMinShare = 1.0f / 64;
    const HairMeasure measure = state.scene.measure();
    const float distance = std::max(distances(state.camera, hair)[0], 1e-3f);
    const float pixel =
        pixelSpread(state.camera, state.options) * (state.camera.isOrthographic() ? 1.0f : distance);
    detail.share = std::clamp(measure.diameter / pixel / state.options.detail, kMinShare, 2.0f);
    const float pieces = std::ceil(measure.segment / pixel / kPixelsPerSegment);
    detail.subdivisions =
        static_cast<std::uint32_t>(std::clamp(pieces, 1.0f, static_cast<float>(state.options.subdivisions)));
    return detail;
}

namespace {

Mat4f matrixOf(const Camera& camera, const RenderOptions& options, const Box3f& bounds_ws, float jitterX,
               float jitterY) {
    const auto width = static_cast<float>(options.width);
    const auto height = static_cast<float>(options.height);
    const auto [nearest, farthest] = distances(camera, bounds_ws);
    // Ribbons are at least a pixel wide and turned to the eye, which takes their edges out of the bounds.
    const float pixel = pixelSpread(camera, options) * (camera.isOrthographic() ? 1.0f : farthest);
    const float farPlane = farthest * 1.01f + pixel;
    float nearPlane = std::clamp(nearest * 0.99f - pixel, farPlane * 1e-4f, farPlane * 0.9f);
    // What is behind an eye without perspective is seen as well.
    if (camera.isOrthographic()) {
        const float first = std::min(nearest, farPlane);
        nearPlane = first - 0.01f * (farPlane - first) - 1e-3f;
    }
    Mat4f projection = projectionMatrix(camera, width / height, nearPlane, farPlane);
    projection.row(0) += projection.row(3) * (2 * jitterX / width);
    projection.row(1) += projection.row(3) * (2 * jitterY / height);
    return projection * viewMatrix(camera);
}

}  // namespace

Mat4f cameraMatrix(const RendererState& state, const Box3f& bounds_ws, float jitterX, float jitterY) {
    return matrixOf(state.camera, state.options, bounds_ws, jitterX, jitterY);
}

Mat4f pastCameraMatrix(const RendererState& state) {
    return matrixOf(state.pastCamera.value_or(state.camera), state.options, state.bounds(), 0, 0);
}

void recordFrame(gpu::CommandList& list, RendererState& state, std::uint32_t number) {
    const auto [jitterX, jitterY] = jitter(number, state.options);
    const Mat4f clipFromWorld = cameraMatrix(state, state.bounds(), jitterX, jitterY);
    if (state.plan.runs(Pass::nearest)) {
        recordRasterised(list, state, clipFromWorld, number);
        return;
    }
    const Vec3f& back = state.background;
    const Targets& t = state.targets;

    gpu::PassDesc pass;
    pass.name = passName(Pass::draw);
    pass.colour = {
        {t[TargetId::colour], gpu::LoadOp::Clear, {back.x(), back.y(), back.z(), 1}, t[TargetId::resolved]}};
    if (state.options.transparentBackground) pass.colour[0].clear = {0, 0, 0, 0};
    pass.depth = {t[TargetId::depth], gpu::LoadOp::Clear, 1};
    list.beginPass(pass);
    if (state.scene.triangles() > 0) drawHeads(list, state, clipFromWorld);
    drawTubes(list, state, clipFromWorld, number);
    const bool blend = state.plan.runs(Pass::blend);
    if (!state.scene.batches.empty() && !blend) drawHair(list, state, clipFromWorld, number);
    list.endPass();
    if (blend) recordBlend(list, state, clipFromWorld, number);

    list.beginPass({passName(Pass::accumulate), {}, {}});
    list.setPipeline(state.pipelines.compute("accumulate.comp"));
    shaders::ResolveConstants constants{};
    const std::uint32_t width = state.options.width;
    const std::uint32_t height = state.options.height;
    constants.pixels = width * height;
    constants.rowThreads = width;
    constants.samples = 1;
    constants.sumBegins = number == 0 || state.options.temporal ? 1 : 0;
    list.setConstants(0, gpu::bytesOf(constants));
    bind(list, {Binding::read(0, t.frame()), Binding::write(0, state.frames())});
    list.dispatch(groupsFor(width, HAIRLOOM_TILE_GROUP), groupsFor(height, HAIRLOOM_TILE_GROUP));
    list.endPass();
}

}  // namespace hairloom::render
