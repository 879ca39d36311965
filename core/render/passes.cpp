// SPDX-License-Identifier: GPL-3.0-or-later
// Curves, shadow maps and shading, then frames that only transform and rasterise.
#include "core/render/passes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "core/shading/kajiya_kay.h"

namespace hairloom::render {
namespace {

using gpu::Binding;

// Ends of the four opacity layers behind the first hair, metres: they grow with depth (Yuksel and Keyser
// 2008).
constexpr shaders::float4 kLayers{0.004f, 0.012f, 0.032f, 0.120f};
constexpr GraphicsNeeds kStrandDepth{.vertex = "strand_depth.vert",
                                     .topology = gpu::Topology::TriangleStrip,
                                     .depthTest = true,
                                     .depthWrite = true};
constexpr GraphicsNeeds kStrandOpacity{.vertex = "strand_opacity.vert",
                                       .pixel = "opacity.frag",
                                       .topology = gpu::Topology::TriangleStrip,
                                       .colour = gpu::Format::Rgba16Unorm,
                                       .blend = Blend::add};
constexpr std::uint32_t kGroup = 64;
constexpr std::uint32_t kRowGroups = 32768;

void bind(gpu::CommandList& list, std::initializer_list<Binding> bindings) {
    list.bind(std::span<const Binding>(bindings.begin(), bindings.size()));
}

/// Offsets of a frame in pixels: Gaussian (sigma 0.45), which makes the average a Gaussian filter.
std::array<float, 2> jitter(std::uint32_t number, std::uint32_t frames) {
    if (frames == 1) return {0, 0};
    // The R2 sequence (Roberts 2018), then Box and Muller.
    const double n = number;
    const double u = std::fmod(0.5 + n * 0.7548776662466927, 1.0);
    const double v = std::fmod(0.5 + n * 0.5698402909980532, 1.0);
    const double radius = std::min(0.45 * std::sqrt(-2 * std::log(std::max(u, 1e-3))), 1.5);
    const double angle = 2 * static_cast<double>(kPi) * v;
    return {static_cast<float>(radius * std::cos(angle)), static_cast<float>(radius * std::sin(angle))};
}

shaders::ViewConstants lightConstants(const RendererState& state, std::size_t light) {
    const LightView& view = state.lightViews[light];
    shaders::ViewConstants c;
    c.clipFromWorld = toShader(view.clipFromWorld);
    c.eye_ws = toShader(state.lights[light].toLight_ws.normalized(), 0);
    c.pixel = {view.width / static_cast<float>(state.options.shadowResolution), 1, 0, 0};
    c.sampling = {1, 0, 0, 0};
    c.layers = kLayers;
    c.range = {view.depthRange, 0, 0, 0};
    return c;
}

void setTile(gpu::CommandList& list, const RendererState& state, std::size_t light) {
    const std::uint32_t size = state.options.shadowResolution;
    const auto x = static_cast<std::uint32_t>(light) * size;
    list.setViewport({static_cast<float>(x), 0, static_cast<float>(size), static_cast<float>(size), 0, 1});
    list.setScissor({x, 0, size, size});
}

void drawStrands(gpu::CommandList& list, const StrandBatch& batch, std::uint32_t subdivisions) {
    bind(list, {Binding::read(0, batch.curve), Binding::read(1, batch.colour)});
    list.setIndexBuffer(batch.indices.at(subdivisions));
    list.drawIndexed(batch.indexCount(subdivisions));
}

void drawAllStrands(gpu::CommandList& list, const RendererState& state) {
    for (const StrandBatch& batch : state.scene.batches) {
        drawStrands(list, batch, state.options.subdivisions);
    }
}

void bindShadows(gpu::CommandList& list, const RendererState& state) {
    bind(list, {Binding::read(8, state.targets.headDepth), Binding::read(9, state.targets.firstHair),
                Binding::read(10, state.targets.opacity)});
}

bool castsShadow(const RendererState& state, std::size_t light) {
    return state.options.shadows && state.lights[light].castsShadow;
}

}  // namespace

shaders::float4x4 toShader(const Mat4f& m) {
    shaders::float4x4 result;
    std::memcpy(result.m, m.data(), sizeof(result.m));
    return result;
}

shaders::float4 toShader(const Vec3f& v, float w) {
    return {v.x(), v.y(), v.z(), w};
}

Box3f RendererState::bounds() const {
    Box3f box = scene.meshBounds();
    box.extend(scene.hairBounds());
    return box;
}

Mat4f cameraMatrix(const RendererState& state, const Box3f& bounds, float jitterX, float jitterY) {
    const Camera& camera = state.camera;
    const auto width = static_cast<float>(state.options.width);
    const auto height = static_cast<float>(state.options.height);
    const Mat4f view = viewMatrix(camera);
    float nearest = 1e30f;
    float farthest = 0.1f;
    for (int i = 0; i < 8 && !bounds.isEmpty(); ++i) {
        const Vec3f corner = bounds.corner(static_cast<Box3f::CornerType>(i));
        const float distance = -(view * corner.homogeneous()).z();
        nearest = std::min(nearest, distance);
        farthest = std::max(farthest, distance);
    }
    const float farPlane = farthest * 1.01f;
    const float nearPlane = std::clamp(nearest * 0.99f, farPlane * 1e-4f, farPlane * 0.9f);
    Mat4f projection = projectionMatrix(camera.verticalFov, width / height, nearPlane, farPlane);
    projection.row(0) += projection.row(3) * (2 * jitterX / width);
    projection.row(1) += projection.row(3) * (2 * jitterY / height);
    return projection * view;
}

void drawMeshes(gpu::CommandList& list, const RendererState& state) {
    for (const MeshOnDevice& mesh : state.scene.meshes) {
        if (mesh.indices.empty()) continue;
        bind(list, {Binding::read(0, mesh.positions), Binding::read(1, mesh.normals),
                    Binding::read(2, mesh.indexBuffer), Binding::read(3, mesh.albedo)});
        list.draw(static_cast<std::uint32_t>(mesh.indices.size()));
    }
}

void setUpLights(RendererState& state) {
    Box3f box = state.scene.hairBounds();
    if (box.isEmpty()) box = state.scene.meshBounds();
    if (box.isEmpty()) box = Box3f(Vec3f::Constant(-0.1f), Vec3f::Constant(0.1f));
    const Vec3f margin = Vec3f::Constant(0.12f * box.diagonal().norm() + 1e-4f);
    box = Box3f(box.min() - margin, box.max() + margin);

    shaders::ShadeConstants& shade = state.shade;
    shade.eye_ws = toShader(state.camera.eye_ws, 1);
    shade.ambientSky = toShader(state.ambientSky, 0);
    shade.ambientGround = toShader(state.ambientGround, 0);
    shade.layers = kLayers;
    state.lightViews.clear();
    shade.counts.y = static_cast<std::uint32_t>(state.lights.size());
    for (std::size_t i = 0; i < state.lights.size(); ++i) {
        const Light& light = state.lights[i];
        state.lightViews.push_back(fitLight(light.toLight_ws, box));
        shaders::LightConstants& c = shade.lights[i];
        c.clipFromWorld = toShader(state.lightViews[i].clipFromWorld);
        c.toLight_ws = toShader(light.toLight_ws.normalized(), 0);
        c.irradiance = toShader(light.irradiance, 0);
        c.tile = {static_cast<float>(i) / static_cast<float>(kMaxLights), 0, 0, 0};
        c.range = {state.lightViews[i].depthRange, castsShadow(state, i) ? 1.0f : 0.0f, 0, 0};
    }
}

shaders::ShadeConstants shadeConstants(const RendererState& state, const HairMaterial& m) {
    shaders::ShadeConstants c = state.shade;
    const auto normalisation = [](float exponent) {
        return static_cast<float>(1 / (static_cast<double>(kPi) * shading::kajiyaReflectance(exponent)));
    };
    c.primary = toShader(m.primary, m.primaryExponent);
    c.secondary = toShader(m.secondary, m.secondaryExponent);
    c.shift = {std::tan(radians(m.primaryShift)), std::tan(radians(m.secondaryShift)), m.diffuse,
               m.scattering};
    c.normalisation = {normalisation(0), normalisation(m.primaryExponent), normalisation(m.secondaryExponent),
                       0};
    c.albedo = toShader(m.albedo, 0);
    c.rootTip = {m.rootBrightness, m.tipBrightness, m.variation, m.opacity};
    return c;
}

void recordCurves(gpu::CommandList& list, RendererState& state) {
    list.beginPass({"curves", {}, {}});
    list.setPipeline(state.pipelines.compute("curve.comp"));
    for (const StrandBatch& batch : state.scene.batches) {
        const StrandGroup& group = state.scene.groups[batch.group];
        const bool own = group.devicePositions == nullptr;
        shaders::CurveConstants constants;
        constants.strandCount = batch.strandCount;
        constants.subdivisions = state.options.subdivisions;
        constants.floatsPerPoint = own ? 3 : group.floatsPerPoint;
        constants.strandMajor = own ? 0 : static_cast<std::uint32_t>(group.strandCount);
        constants.radius = {group.material.radius, group.material.tipScale, group.hasRadii ? 1.0f : 0.0f, 0};
        list.setConstants(0, gpu::bytesOf(constants));
        bind(list, {Binding::read(0, batch.headers),
                    Binding::read(1, own ? batch.positions : group.devicePositions),
                    Binding::read(2, batch.radii), Binding::write(0, batch.curve)});
        list.dispatch((batch.strandCount + kGroup - 1) / kGroup);
    }
    list.endPass();
}

void recordShadowMaps(gpu::CommandList& list, RendererState& state) {
    const std::size_t lights = state.lights.size();
    const auto forStrands = [&] {
        for (std::size_t i = 0; i < lights; ++i) {
            if (!castsShadow(state, i)) continue;
            setTile(list, state, i);
            list.setConstants(0, gpu::bytesOf(lightConstants(state, i)));
            drawAllStrands(list, state);
        }
    };
    list.beginPass({"head depth", {}, {state.targets.headDepth, gpu::LoadOp::Clear, 1}});
    list.setPipeline(state.pipelines.graphics(kMeshDepth));
    for (std::size_t i = 0; i < lights; ++i) {
        if (!castsShadow(state, i)) continue;
        setTile(list, state, i);
        shaders::MeshConstants constants;
        constants.clipFromWorld = toShader(state.lightViews[i].clipFromWorld);
        list.setConstants(1, gpu::bytesOf(constants));
        drawMeshes(list, state);
    }
    list.endPass();

    list.beginPass({"first hair", {}, {state.targets.firstHair, gpu::LoadOp::Clear, 1}});
    list.setPipeline(state.pipelines.graphics(kStrandDepth));
    forStrands();
    list.endPass();

    list.beginPass({"opacity layers", {{state.targets.opacity, gpu::LoadOp::Clear, {0, 0, 0, 0}, {}}}, {}});
    list.setPipeline(state.pipelines.graphics(kStrandOpacity));
    bind(list, {Binding::read(2, state.targets.firstHair)});
    forStrands();
    list.endPass();
}

void recordShading(gpu::CommandList& list, RendererState& state) {
    list.beginPass({"shade", {}, {}});
    list.setPipeline(state.pipelines.compute("shade.comp"));
    bindShadows(list, state);
    for (const StrandBatch& batch : state.scene.batches) {
        auto constants = shadeConstants(state, state.scene.groups[batch.group].material);
        const std::uint32_t points = batch.curvePoints(state.options.subdivisions);
        const std::uint32_t groups = (points + kGroup - 1) / kGroup;
        const std::uint32_t row = std::min(groups, kRowGroups);
        constants.counts = {points, constants.counts.y, row * kGroup, 0};
        list.setConstants(0, gpu::bytesOf(constants));
        bind(list, {Binding::read(0, batch.curve), Binding::read(1, batch.headers),
                    Binding::write(0, batch.colour)});
        list.dispatch(row, (groups + row - 1) / row);
    }
    list.endPass();
}

void recordFrame(gpu::CommandList& list, RendererState& state, std::uint32_t number) {
    const auto [jitterX, jitterY] = jitter(number, state.options.frames);
    const Mat4f clipFromWorld = cameraMatrix(state, state.bounds(), jitterX, jitterY);
    const Vec3f& back = state.background;
    const Targets& t = state.targets;
    const float alpha = state.options.transparentBackground ? 0.0f : 1.0f;

    gpu::PassDesc pass;
    pass.name = "draw";
    pass.colour = {{t.colour, gpu::LoadOp::Clear, {back.x(), back.y(), back.z(), alpha}, t.resolved}};
    if (state.options.transparentBackground) pass.colour[0].clear = {0, 0, 0, 0};
    pass.depth = {t.depth, gpu::LoadOp::Clear, 1};
    list.beginPass(pass);
    if (state.scene.triangles() > 0) {
        list.setPipeline(state.pipelines.graphics({.vertex = "mesh.vert",
                                                   .pixel = "mesh.frag",
                                                   .colour = kColourFormat,
                                                   .depthTest = true,
                                                   .depthWrite = true,
                                                   .samples = state.samples}));
        bindShadows(list, state);
        list.setConstants(0, gpu::bytesOf(state.shade));
        shaders::MeshConstants mesh;
        mesh.clipFromWorld = toShader(clipFromWorld);
        mesh.skin = {0.35f, 0.6f, 28, 0};
        list.setConstants(1, gpu::bytesOf(mesh));
        drawMeshes(list, state);
    }
    if (!state.scene.batches.empty()) {
        shaders::ViewConstants view;
        view.clipFromWorld = toShader(clipFromWorld);
        view.eye_ws = toShader(state.camera.eye_ws, 1);
        const float pixel = 2 * std::tan(radians(state.camera.verticalFov) / 2);
        view.pixel = {pixel / static_cast<float>(state.options.height), 1, 0, 0};
        view.sampling = {state.samples, number, 0, 0};
        list.setPipeline(state.pipelines.graphics({.vertex = "strand.vert",
                                                   .pixel = "strand.frag",
                                                   .topology = gpu::Topology::TriangleStrip,
                                                   .colour = kColourFormat,
                                                   .depthTest = true,
                                                   .depthWrite = true,
                                                   .samples = state.samples}));
        list.setConstants(0, gpu::bytesOf(view));
        drawAllStrands(list, state);
    }
    list.endPass();

    list.beginPass({"accumulate",
                    {{t.sum, number == 0 ? gpu::LoadOp::Clear : gpu::LoadOp::Load, {0, 0, 0, 0}, {}}},
                    {}});
    list.setPipeline(state.pipelines.graphics({.vertex = "fullscreen.vert",
                                               .pixel = "accumulate.frag",
                                               .colour = gpu::Format::Rgba32Float,
                                               .blend = Blend::add}));
    bind(list, {Binding::read(0, t.frame())});
    list.draw(3);
    list.endPass();
}

}  // namespace hairloom::render
