// SPDX-License-Identifier: GPL-3.0-or-later
// The frame graph: curves, shadow maps, shading, then frames that only transform and rasterise.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "core/render/picture_internal.h"
#include "core/shading/kajiya_kay.h"

namespace hairloom::render {
namespace {

using gpu::Binding;

// Ends of the four opacity layers behind the first hair, metres: they grow with depth (Yuksel and Keyser
// 2008).
constexpr shaders::float4 kLayers{0.004f, 0.012f, 0.032f, 0.120f};
constexpr std::uint32_t kGroup = 64;
constexpr std::uint32_t kRowGroups = 32768;

shaders::float4x4 toShader(const Mat4f& m) {
    shaders::float4x4 result;
    std::memcpy(result.m, m.data(), sizeof(result.m));
    return result;
}

shaders::float4 toShader(const Vec3f& v, float w) {
    return {v.x(), v.y(), v.z(), w};
}

void bind(gpu::CommandList& list, std::initializer_list<Binding> bindings) {
    list.bind(std::span<const Binding>(bindings.begin(), bindings.size()));
}

Mat4f cameraMatrix(const Frame& frame, float jitterX, float jitterY) {
    const Camera& camera = frame.scene.camera;
    const auto width = static_cast<float>(frame.options.width);
    const auto height = static_cast<float>(frame.options.height);
    const Mat4f view = viewMatrix(camera);
    float nearest = 1e30f;
    float farthest = 0.1f;
    for (int i = 0; i < 8 && !frame.data.bounds_ws.isEmpty(); ++i) {
        const Vec3f corner = frame.data.bounds_ws.corner(static_cast<Box3f::CornerType>(i));
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

shaders::ViewConstants lightConstants(const Frame& frame, std::size_t light) {
    const LightView& view = frame.lightViews[light];
    shaders::ViewConstants c;
    c.clipFromWorld = toShader(view.clipFromWorld);
    c.eye_ws = toShader(frame.scene.lights[light].toLight_ws.normalized(), 0);
    c.pixel = {view.width / static_cast<float>(frame.options.shadowResolution), 1, 0, 0};
    c.sampling = {1, 0, 0, 0};
    c.layers = kLayers;
    c.range = {view.depthRange, 0, 0, 0};
    return c;
}

void setTile(gpu::CommandList& list, const Frame& frame, std::size_t light) {
    const std::uint32_t size = frame.options.shadowResolution;
    const auto x = static_cast<std::uint32_t>(light) * size;
    list.setViewport({static_cast<float>(x), 0, static_cast<float>(size), static_cast<float>(size), 0, 1});
    list.setScissor({x, 0, size, size});
}

void drawStrands(gpu::CommandList& list, const StrandBatch& batch) {
    bind(list, {Binding::read(0, batch.curve), Binding::read(1, batch.colour)});
    list.setIndexBuffer(batch.indices);
    list.drawIndexed(batch.indexCount);
}

void bindMesh(gpu::CommandList& list, const MeshOnDevice& mesh) {
    bind(list, {Binding::read(0, mesh.positions), Binding::read(1, mesh.normals),
                Binding::read(2, mesh.indices), Binding::read(3, mesh.albedo)});
}

void bindShadows(gpu::CommandList& list, const Frame& frame) {
    bind(list, {Binding::read(8, frame.targets.headDepth), Binding::read(9, frame.targets.firstHair),
                Binding::read(10, frame.targets.opacity)});
}

void recordCurves(gpu::CommandList& list, const Frame& frame) {
    list.beginPass({"curves", {}, {}});
    list.setPipeline(frame.pipelines.curve);
    for (const StrandBatch& batch : frame.data.batches) {
        const shaders::CurveConstants constants{batch.strandCount, frame.options.subdivisions, 0, 0};
        list.setConstants(0, gpu::bytesOf(constants));
        bind(list, {Binding::read(0, batch.headers), Binding::read(1, batch.points),
                    Binding::write(0, batch.curve)});
        list.dispatch((batch.strandCount + kGroup - 1) / kGroup);
    }
    list.endPass();
}

bool castsShadow(const Frame& frame, std::size_t light) {
    return frame.options.shadows && frame.scene.lights[light].castsShadow;
}

void recordShadowMaps(gpu::CommandList& list, const Frame& frame) {
    const std::size_t lights = frame.scene.lights.size();
    const auto forStrands = [&] {
        for (std::size_t i = 0; i < lights; ++i) {
            if (!castsShadow(frame, i)) continue;
            setTile(list, frame, i);
            list.setConstants(0, gpu::bytesOf(lightConstants(frame, i)));
            for (const StrandBatch& batch : frame.data.batches) drawStrands(list, batch);
        }
    };
    list.beginPass({"head depth", {}, {frame.targets.headDepth, gpu::LoadOp::Clear, 1}});
    list.setPipeline(frame.pipelines.meshDepth);
    for (std::size_t i = 0; i < lights; ++i) {
        if (!castsShadow(frame, i)) continue;
        setTile(list, frame, i);
        shaders::MeshConstants constants;
        constants.clipFromWorld = toShader(frame.lightViews[i].clipFromWorld);
        list.setConstants(1, gpu::bytesOf(constants));
        for (const MeshOnDevice& mesh : frame.data.meshes) {
            bindMesh(list, mesh);
            list.draw(mesh.corners);
        }
    }
    list.endPass();

    list.beginPass({"first hair", {}, {frame.targets.firstHair, gpu::LoadOp::Clear, 1}});
    list.setPipeline(frame.pipelines.strandDepth);
    forStrands();
    list.endPass();

    list.beginPass({"opacity layers", {{frame.targets.opacity, gpu::LoadOp::Clear, {0, 0, 0, 0}, {}}}, {}});
    list.setPipeline(frame.pipelines.strandOpacity);
    bind(list, {Binding::read(2, frame.targets.firstHair)});
    forStrands();
    list.endPass();
}

void recordShading(gpu::CommandList& list, const Frame& frame) {
    list.beginPass({"shade", {}, {}});
    list.setPipeline(frame.pipelines.shade);
    bindShadows(list, frame);
    for (const StrandBatch& batch : frame.data.batches) {
        auto constants = shadeConstants(frame, frame.scene.strands[batch.group].material);
        const std::uint32_t groups = (batch.curvePoints + kGroup - 1) / kGroup;
        const std::uint32_t row = std::min(groups, kRowGroups);
        constants.counts = {batch.curvePoints, constants.counts.y, row * kGroup, 0};
        list.setConstants(0, gpu::bytesOf(constants));
        bind(list, {Binding::read(0, batch.curve), Binding::read(1, batch.headers),
                    Binding::write(0, batch.colour)});
        list.dispatch(row, (groups + row - 1) / row);
    }
    list.endPass();
}

}  // namespace

void setUpLights(Frame& frame) {
    const SceneOnDevice& data = frame.data;
    Box3f box = data.hairBounds_ws.isEmpty() ? data.bounds_ws : data.hairBounds_ws;
    if (box.isEmpty()) box = Box3f(Vec3f::Constant(-0.1f), Vec3f::Constant(0.1f));
    const Vec3f margin = Vec3f::Constant(0.12f * box.diagonal().norm() + 1e-4f);
    box = Box3f(box.min() - margin, box.max() + margin);

    shaders::ShadeConstants& shade = frame.shade;
    shade.eye_ws = toShader(frame.scene.camera.eye_ws, 1);
    shade.ambientSky = toShader(frame.scene.ambientSky, 0);
    shade.ambientGround = toShader(frame.scene.ambientGround, 0);
    shade.layers = kLayers;
    shade.counts.y = static_cast<std::uint32_t>(frame.scene.lights.size());
    for (std::size_t i = 0; i < frame.scene.lights.size(); ++i) {
        const Light& light = frame.scene.lights[i];
        frame.lightViews.push_back(fitLight(light.toLight_ws, box));
        shaders::LightConstants& c = shade.lights[i];
        c.clipFromWorld = toShader(frame.lightViews[i].clipFromWorld);
        c.toLight_ws = toShader(light.toLight_ws.normalized(), 0);
        c.irradiance = toShader(light.irradiance, 0);
        c.tile = {static_cast<float>(i) / static_cast<float>(kMaxLights), 0, 0, 0};
        c.range = {frame.lightViews[i].depthRange, castsShadow(frame, i) ? 1.0f : 0.0f, 0, 0};
    }
}

shaders::ShadeConstants shadeConstants(const Frame& frame, const HairMaterial& m) {
    shaders::ShadeConstants c = frame.shade;
    const auto normalisation = [](float exponent) {
        return static_cast<float>(1 / (static_cast<double>(kPi) * shading::kajiyaReflectance(exponent)));
    };
    c.primary = toShader(m.primary, m.primaryExponent);
    c.secondary = toShader(m.secondary, m.secondaryExponent);
    c.shift = {std::tan(radians(m.primaryShift)), std::tan(radians(m.secondaryShift)), m.diffuse,
               m.scattering};
    c.normalisation = {normalisation(0), normalisation(m.primaryExponent), normalisation(m.secondaryExponent),
                       0};
    c.rootTip = {m.rootBrightness, m.tipBrightness, m.variation, m.opacity};
    return c;
}

void recordPreparation(gpu::CommandList& list, const Frame& frame) {
    if (!frame.data.batches.empty()) recordCurves(list, frame);
    recordShadowMaps(list, frame);
    if (!frame.data.batches.empty()) recordShading(list, frame);
}

void recordFrame(gpu::CommandList& list, const Frame& frame, std::uint32_t number) {
    const auto [jitterX, jitterY] = jitter(number, frame.options.frames);
    const Mat4f clipFromWorld = cameraMatrix(frame, jitterX, jitterY);
    const Vec3f& back = frame.scene.background;
    const Targets& t = frame.targets;
    const float alpha = frame.options.transparentBackground ? 0.0f : 1.0f;

    gpu::PassDesc pass;
    pass.name = "draw";
    pass.colour = {{t.colour, gpu::LoadOp::Clear, {back.x(), back.y(), back.z(), alpha}, t.resolved}};
    if (frame.options.transparentBackground) pass.colour[0].clear = {0, 0, 0, 0};
    pass.depth = {t.depth, gpu::LoadOp::Clear, 1};
    list.beginPass(pass);
    if (!frame.data.meshes.empty()) {
        list.setPipeline(frame.pipelines.mesh);
        bindShadows(list, frame);
        list.setConstants(0, gpu::bytesOf(frame.shade));
        shaders::MeshConstants mesh;
        mesh.clipFromWorld = toShader(clipFromWorld);
        mesh.skin = {0.35f, 0.6f, 28, 0};
        list.setConstants(1, gpu::bytesOf(mesh));
        for (const MeshOnDevice& m : frame.data.meshes) {
            bindMesh(list, m);
            list.draw(m.corners);
        }
    }
    if (!frame.data.batches.empty()) {
        shaders::ViewConstants view;
        view.clipFromWorld = toShader(clipFromWorld);
        view.eye_ws = toShader(frame.scene.camera.eye_ws, 1);
        const float pixel = 2 * std::tan(radians(frame.scene.camera.verticalFov) / 2);
        view.pixel = {pixel / static_cast<float>(frame.options.height), 1, 0, 0};
        view.sampling = {frame.samples, number, 0, 0};
        list.setPipeline(frame.pipelines.strand);
        list.setConstants(0, gpu::bytesOf(view));
        for (const StrandBatch& batch : frame.data.batches) drawStrands(list, batch);
    }
    list.endPass();

    list.beginPass({"accumulate",
                    {{t.sum, number == 0 ? gpu::LoadOp::Clear : gpu::LoadOp::Load, {0, 0, 0, 0}, {}}},
                    {}});
    list.setPipeline(frame.pipelines.accumulate);
    bind(list, {Binding::read(0, frame.samples > 1 ? t.resolved : t.colour)});
    list.draw(3);
    list.endPass();
}

}  // namespace hairloom::render
