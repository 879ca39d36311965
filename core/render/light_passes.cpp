// SPDX-License-Identifier: GPL-3.0-or-later
// Curves, shadow maps and shading: what stays while the scene does.
#include <algorithm>
#include <cmath>

#include "core/render/passes.h"
#include "core/shading/kajiya_kay.h"

namespace hairloom::render {
namespace {

using gpu::Binding;

constexpr GraphicsNeeds kStrandDepth{.vertex = "strand_depth.vert",
                                     .topology = gpu::Topology::TriangleStrip,
                                     .depthTest = true,
                                     .depthWrite = true};
constexpr std::uint32_t kGroup = 64;
constexpr std::uint32_t kRowGroups = 32768;

bool castsShadow(const RendererState& state, std::size_t light) {
    return state.options.shadows != Shadows::none && state.lights[light].castsShadow;
}

/// Place of a light's square in the atlas.
std::uint32_t tileOf(const RendererState& state, std::size_t light) {
    std::uint32_t tile = 0;
    for (std::size_t i = 0; i < light; ++i) tile += castsShadow(state, i) ? 1 : 0;
    return tile;
}

shaders::float4 layersOf(const RendererState& state, const LightView& view) {
    const float range = view.hairRange;
    switch (state.options.shadows) {
        case Shadows::deepOpacity:
            return {state.deepLayers[0] * range, state.deepLayers[1] * range, state.deepLayers[2] * range, 0};
        case Shadows::opacityMaps:
            return {0.25f * range, 0.5f * range, 0.75f * range, range};
        case Shadows::absorption: {
            const HairMeasure measure = state.scene.measure();
            return {measure.fibresPerMetre, measure.fibresThrough, 0, 0};
        }
        case Shadows::none:
            break;
    }
    return {};
}

shaders::float4 rangeOf(const LightView& view, std::uint32_t mode) {
    return {view.depthRange, static_cast<float>(mode), view.nearPlane, view.hairStart};
}

shaders::LightConstants lightConstants(const RendererState& state, std::size_t i) {
    const Light& light = state.lights[i];
    const LightView& view = state.lightViews[i];
    const bool hair = castsShadow(state, i) && !state.scene.batches.empty();
    const bool head = castsShadow(state, i) && state.plan.runs(Pass::headDepth);
    const auto size = static_cast<float>(state.options.shadowResolution);
    shaders::LightConstants c;
    c.clipFromWorld = toShader(view.clipFromWorld);
    c.toLight_ws = {view.eye_ws.x(), view.eye_ws.y(), view.eye_ws.z(), view.eye_ws.w()};
    c.irradiance = toShader(light.kind == LightKind::point ? light.intensity : light.irradiance, 0);
    c.tile = {size * static_cast<float>(tileOf(state, i)), size, head ? 1.0f : 0.0f, 0};
    c.range = rangeOf(view, hair ? static_cast<std::uint32_t>(state.options.shadows) : 0u);
    c.layers = layersOf(state, view);
    return c;
}

/// For drawing strands into a light's square.
shaders::ViewConstants lightViewConstants(const RendererState& state, std::size_t light) {
    const LightView& view = state.lightViews[light];
    const auto mode = static_cast<std::uint32_t>(state.options.shadows);
    shaders::ViewConstants c;
    c.clipFromWorld = toShader(view.clipFromWorld);
    c.eye_ws = {view.eye_ws.x(), view.eye_ws.y(), view.eye_ws.z(), view.eye_ws.w()};
    c.pixel = {view.spread / static_cast<float>(state.options.shadowResolution), 1, 0, 0};
    c.sampling = {1, 0, 0, mode};
    c.layers = layersOf(state, view);
    c.range = rangeOf(view, mode);
    return c;
}

void setTile(gpu::CommandList& list, const RendererState& state, std::size_t light) {
    const std::uint32_t size = state.options.shadowResolution;
    const std::uint32_t x = tileOf(state, light) * size;
    list.setViewport({static_cast<float>(x), 0, static_cast<float>(size), static_cast<float>(size), 0, 1});
    list.setScissor({x, 0, size, size});
}

void drawStrandsFromLights(gpu::CommandList& list, const RendererState& state) {
    for (std::size_t i = 0; i < state.lights.size(); ++i) {
        if (!castsShadow(state, i)) continue;
        setTile(list, state, i);
        list.setConstants(0, gpu::bytesOf(lightViewConstants(state, i)));
        drawStrips(list, state);
    }
}

void recordHeadDepth(gpu::CommandList& list, RendererState& state) {
    list.beginPass(
        {passName(Pass::headDepth), {}, {state.targets[TargetId::headDepth], gpu::LoadOp::Clear, 1}});
    list.setPipeline(state.pipelines.graphics(kMeshDepth));
    for (std::size_t i = 0; i < state.lights.size(); ++i) {
        if (!castsShadow(state, i)) continue;
        setTile(list, state, i);
        shaders::MeshConstants constants;
        constants.clipFromWorld = toShader(state.lightViews[i].clipFromWorld);
        list.setConstants(1, gpu::bytesOf(constants));
        drawMeshes(list, state);
    }
    list.endPass();
}

shaders::CurveConstants curveConstants(const RendererState& state, const StrandBatch& batch) {
    const StrandGroup& group = state.scene.groups[batch.group];
    const bool own = group.devicePositions == nullptr;
    const HairMaterial& material = group.material;
    shaders::CurveConstants c;
    c.strandCount = batch.strandCount(state.detail);
    c.subdivisions = state.detail.subdivisions;
    c.floatsPerPoint = own ? 3 : group.floatsPerPoint;
    c.strandMajor = own ? 0 : static_cast<std::uint32_t>(group.strandCount);
    c.radius = {material.radius, material.tipScale, group.hasRadii ? 1.0f : 0.0f, material.radiusVariation};
    c.detail = {0.9f * state.detail.share, 1.1f * state.detail.share,
                1 / static_cast<float>(batch.strandCount()), state.detail.widening()};
    return c;
}

}  // namespace

void setUpLights(RendererState& state) {
    const std::vector<Vec3f> hair = state.scene.sample();
    const Box3f all = state.bounds();
    std::vector<Vec3f> fitted = hair;
    for (int i = 0; i < 8 && hair.empty() && !all.isEmpty(); ++i) {
        fitted.push_back(all.corner(static_cast<Box3f::CornerType>(i)));
    }
    state.lightViews.clear();
    for (const Light& light : state.lights) state.lightViews.push_back(fitLight(light, fitted, all));

    shaders::ShadeConstants& shade = state.shade;
    shade.eye_ws = toShader(state.camera.eye_ws, 1);
    for (std::size_t i = 0; i < state.environment.coefficients.size(); ++i) {
        shade.environment[i] =
            toShader(state.environment.coefficients[i], state.environment.dark() ? 0.0f : 1.0f);
    }
    shade.counts.y = static_cast<std::uint32_t>(state.lights.size());
    for (std::size_t i = 0; i < state.lights.size(); ++i) shade.lights[i] = lightConstants(state, i);
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
    list.beginPass({passName(Pass::curves), {}, {}});
    list.setPipeline(state.pipelines.compute("curve.comp"));
    for (const StrandBatch& batch : state.scene.batches) {
        const StrandGroup& group = state.scene.groups[batch.group];
        const shaders::CurveConstants constants = curveConstants(state, batch);
        list.setConstants(0, gpu::bytesOf(constants));
        bind(list, {Binding::read(0, batch.headers),
                    Binding::read(1, group.devicePositions ? group.devicePositions : batch.positions),
                    Binding::read(2, batch.radii), Binding::write(0, batch.curve)});
        list.dispatch((constants.strandCount + kGroup - 1) / kGroup);
    }
    list.endPass();
}

void recordShadowMaps(gpu::CommandList& list, RendererState& state) {
    if (state.plan.runs(Pass::headDepth)) recordHeadDepth(list, state);
    if (state.plan.runs(Pass::firstHair)) {
        list.beginPass(
            {passName(Pass::firstHair), {}, {state.targets[TargetId::firstHair], gpu::LoadOp::Clear, 1}});
        list.setPipeline(state.pipelines.graphics(kStrandDepth));
        drawStrandsFromLights(list, state);
        list.endPass();
    }
    if (!state.plan.runs(Pass::opacity)) return;
    const bool deep = state.options.shadows == Shadows::deepOpacity;
    list.beginPass({passName(Pass::opacity),
                    {{state.targets[TargetId::opacity], gpu::LoadOp::Clear, {0, 0, 0, 0}, {}}},
                    {}});
    list.setPipeline(state.pipelines.graphics({.vertex = "strand_opacity.vert",
                                               .pixel = "opacity.frag",
                                               .topology = gpu::Topology::TriangleStrip,
                                               .colour = gpu::Format::Rgba16Unorm,
                                               .blend = deep ? Blend::addAndNearest : Blend::add}));
    bind(list, {Binding::read(2, state.orNothing(TargetId::firstHair))});
    drawStrandsFromLights(list, state);
    list.endPass();
}

void recordShading(gpu::CommandList& list, RendererState& state) {
    list.beginPass({passName(Pass::shade), {}, {}});
    bindShadows(list, state);
    for (const StrandBatch& batch : state.scene.batches) {
        const StrandGroup& group = state.scene.groups[batch.group];
        list.setPipeline(state.pipelines.compute(group.fibre.shader()));
        group.fibre.bind(list);
        auto constants = shadeConstants(state, group.material);
        const std::uint32_t points =
            batch.curvePoints(batch.strandCount(state.detail), state.detail.subdivisions);
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

}  // namespace hairloom::render
