// SPDX-License-Identifier: GPL-3.0-or-later
// Curves, what they see of the sky, and shading: what stays while the scene does.
#include <cmath>
#include <limits>

#include "core/render/light_cut.h"
#include "core/render/passes.h"
#include "core/render/shadow_maps.h"
#include "core/shading/kajiya_kay.h"

namespace hairloom::render {
namespace {

using gpu::Binding;

shaders::CurveConstants curveConstants(const RendererState& state, const DrawBatch& batch) {
    const StrandGroup& group = state.scene.groups[batch.group];
    const bool own = group.devicePositions == nullptr;
    const StrandShading& material = state.scene.materialOf(batch).shading;
    shaders::CurveConstants c{};
    c.strandCount = batch.strandCount(state.detail);
    c.subdivisions = state.detail.subdivisions;
    c.floatsPerPoint = own ? 3 : group.floatsPerPoint;
    c.firstPoint = own ? 0 : static_cast<std::uint32_t>(batch.firstPoint);
    c.rootRadius = material.radius;
    c.tipScale = material.tipScale;
    c.radiusVariation = material.radiusVariation;
    c.hasRadii = group.hasRadiiOf(batch.material) ? 1 : 0;
    c.fullShare = 0.9f * state.detail.share;
    c.goneShare = 1.1f * state.detail.share;
    c.strandShare = 1 / static_cast<float>(batch.strandCount());
    c.widening = state.detail.widening();
    c.rootOpacity = material.rootOpacity;
    c.tipOpacity = material.tipOpacity;
    return c;
}

const gpu::BufferPtr& pointsOf(const StrandGroup& group, const DrawBatch& batch) {
    if (group.devicePositions == nullptr) return batch.positions;
    return group.deviceFloats ? group.deviceFloats : group.devicePositions;
}

}  // namespace

void takeLights(RendererState& state, std::span<const Light> lights, const Environment& environment,
                std::uint32_t shadowLights) {
    const Box3f hair = state.scene.hairBounds();
    const Box3f box = hair.isEmpty() ? state.bounds() : hair;
    const Vec3f centre_ws = box.isEmpty() ? Vec3f(Vec3f::Zero()) : Vec3f(box.center());
    LightCut cut = cutLights(lights, environment, centre_ws, {shadowLights, kMaxLights});
    state.lights = std::move(cut.lights);
    state.environment = std::move(cut.rest);
}

void setUpLights(RendererState& state) {
    shaders::ShadeConstants& shade = state.shade;
    shade.eye_ws = eyeOf(state.camera);
    shade.ownWidth = 1 / state.detail.widening();
    for (std::size_t i = 0; i < state.environment.coefficients.size(); ++i) {
        shade.environment[i] = toShader(state.environment.coefficients[i], 0);
    }
    shade.hasEnvironment = state.environment.dark() ? 0 : 1;
    shade.hasSkyMaps = state.plan.runs(Pass::skyHead) || state.plan.runs(Pass::skyLayers) ? 1 : 0;
    shade.ground = toShader(state.scene.groundAlbedo(), 0);
    const HairFlux flux = state.scene.flux();
    shade.scattered = toShader(flux.scattered, 0);
    shade.firstMoment = toShader(flux.first, 0);
    shade.secondMoment = toShader(flux.second, 0);
    shade.clumping = flux.ofFibres ? state.scene.clumping.widest() : 1;
    shade.ofFibres = flux.ofFibres ? 1 : 0;
    const LightGridPlace& grid = state.lightGrid;
    shade.gridOrigin_ws = toShader(grid.origin_ws, grid.side > 0 ? 1 / grid.side : 0);
    const bool hasGrid = grid.side > 0 && state.plan.runs(Pass::lightGrid);
    shade.gridSize = {grid.size[0], grid.size[1], grid.size[2], hasGrid ? 1u : 0u};
    shade.lightCount = static_cast<std::uint32_t>(state.lights.size());
    for (std::size_t i = 0; i < state.lights.size(); ++i) shade.lights[i] = lightConstants(state, i);
    for (std::size_t i = 0; i < state.closeViews.size(); ++i)
        shade.closeMaps[i] = closeMapConstants(state, i);
}

shaders::ShadeConstants lightsOfFrame(const RendererState& state) {
    shaders::ShadeConstants c = state.shade;
    for (shaders::LightConstants& light : c.lights) light.withoutShadows = state.lit ? 1.0f : 0.0f;
    return c;
}

shaders::ShadeConstants shadeConstants(const RendererState& state, const StrandShading& m) {
    shaders::ShadeConstants c = lightsOfFrame(state);
    const auto normalisation = [](float exponent) {
        return static_cast<float>(1 / (static_cast<double>(kPi) * shading::kajiyaReflectance(exponent)));
    };
    c.primary = toShader(m.primary, 0);
    c.secondary = toShader(m.secondary, 0);
    c.primaryExponent = m.primaryExponent;
    c.secondaryExponent = m.secondaryExponent;
    c.primaryTilt = std::tan(radians(m.primaryShift));
    c.secondaryTilt = std::tan(radians(m.secondaryShift));
    c.diffuse = m.diffuse;
    c.scattering = m.scattering;
    c.diffuseNormalisation = normalisation(0);
    c.primaryNormalisation = normalisation(m.primaryExponent);
    c.secondaryNormalisation = normalisation(m.secondaryExponent);
    c.rootBrightness = m.rootBrightness;
    c.tipBrightness = m.tipBrightness;
    c.brightnessVariation = m.variation;
    c.acrossShare = state.closeHair.across;
    c.fibreOpacity = m.opacity;
    c.albedo = toShader(m.albedo, 0);
    c.bounded = m.bounded ? 1 : 0;
    c.axisRatio = m.axisRatio;
    c.brightestTint =
        m.bounded ? 1 / std::max(m.fibreColour.maxCoeff(), 1e-3f) : std::numeric_limits<float>::max();
    return c;
}

shaders::LookConstants lookConstants(const shading::StrandLook& look) {
    const auto rgb = [](const Vec3d& v) { return toShader(v.cast<float>(), 0); };
    shaders::LookConstants c{};
    c.root = rgb(look.root);
    c.tip = rgb(look.tip);
    c.streakRoot = rgb(look.streakRoot);
    c.streakTip = rgb(look.streakTip);
    c.dye = rgb(look.dye);
    c.emissionRoot = rgb(look.emissionRoot);
    c.emissionTip = rgb(look.emissionTip);
    c.gradientStart = static_cast<float>(look.gradient.start);
    c.gradientScale = static_cast<float>(look.gradient.scale);
    c.dyeStart = static_cast<float>(look.dyeAlong.start);
    c.dyeScale = static_cast<float>(look.dyeAlong.scale);
    c.absorbs = look.quantity == shading::LookQuantity::absorption ? 1 : 0;
    c.ownScale = static_cast<float>(look.ownScale);
    c.spread = static_cast<float>(look.spread);
    c.streakPigment = static_cast<float>(look.streakPigment);
    c.regrowthStart = static_cast<float>(look.regrowth.start);
    c.regrowthScale = static_cast<float>(look.regrowth.scale);
    return c;
}

void recordCurves(gpu::CommandList& list, RendererState& state) {
    for (const StrandGroup& group : state.scene.groups) {
        if (group.devicePositions == nullptr || group.deviceFloats == nullptr) continue;
        list.copyBuffer(group.devicePositions, 0, group.deviceFloats, 0, group.deviceFloats->desc().size);
    }
    list.beginPass({passName(Pass::curves), {}, {}});
    list.setPipeline(state.pipelines.compute("curve.comp"));
    for (const DrawBatch& batch : state.scene.batches) {
        const StrandGroup& group = state.scene.groups[batch.group];
        const shaders::CurveConstants constants = curveConstants(state, batch);
        list.setConstants(0, gpu::bytesOf(constants));
        bind(list, {Binding::read(0, batch.headers), Binding::read(1, pointsOf(group, batch)),
                    Binding::read(2, batch.radii), Binding::write(0, batch.curve)});
        list.dispatch(groupsFor(constants.strandCount, HAIRLOOM_LIST_GROUP));
    }
    list.endPass();
}

void recordSkySeen(gpu::CommandList& list, RendererState& state) {
    list.beginPass({passName(Pass::skySeen), {}, {}});
    list.setPipeline(state.pipelines.compute("sky_seen.comp"));
    bindShadows(list, state);
    shaders::ShadeConstants constants = state.shade;
    for (const DrawBatch& batch : state.scene.batches) {
        const std::uint32_t strands = batch.strandCount(state.detail);
        constants.count = strands;
        constants.lightCount = constants.rowThreads = 0;
        constants.subdivisions = state.detail.subdivisions;
        list.setConstants(0, gpu::bytesOf(constants));
        bind(list,
             {Binding::read(0, batch.curve), Binding::read(1, batch.headers), Binding::write(0, batch.seen)});
        list.dispatch(groupsFor(strands, HAIRLOOM_LIST_GROUP), HAIRLOOM_SKY_THREADS_OF_STRAND);
    }
    list.endPass();
}

void dispatchCurvePoints(gpu::CommandList& list, const RendererState& state, const DrawBatch& batch,
                         shaders::ShadeConstants constants, const gpu::BufferPtr& target) {
    const StrandShading& material = state.scene.materialOf(batch).shading;
    if (material.look) {
        list.setConstants(2, gpu::bytesOf(lookConstants(*material.look)));
        bind(list, {Binding::read(2, batch.pointDyes)});
    }
    const std::uint32_t points =
        batch.curvePoints(batch.strandCount(state.detail), state.detail.subdivisions);
    const Rows rows(points);
    constants.count = points;
    constants.rowThreads = rows.threads();
    constants.subdivisions = state.detail.subdivisions;
    list.setConstants(0, gpu::bytesOf(constants));
    bind(list, {Binding::read(0, batch.curve), Binding::read(1, batch.headers),
                Binding::read(3, batch.seen ? batch.seen : state.noSky), Binding::write(0, target)});
    list.dispatch(rows.groups, rows.rows);
}

void recordShading(gpu::CommandList& list, RendererState& state) {
    list.beginPass({passName(Pass::shade), {}, {}});
    bindShadows(list, state);
    for (const DrawBatch& batch : state.scene.batches) {
        const MaterialOnDevice& material = state.scene.materialOf(batch);
        const StrandShading& shading = material.shading;
        const char* const tube = shading.look ? "hair_albedo_look.comp" : "hair_albedo.comp";
        list.setPipeline(state.pipelines.compute(shading.tubes ? tube : material.fibre.shader()));
        if (!shading.tubes) material.fibre.bind(list);
        dispatchCurvePoints(list, state, batch, shadeConstants(state, shading), state.colourOf(batch));
    }
    list.endPass();
}

void recordAcross(gpu::CommandList& list, RendererState& state) {
    list.beginPass({passName(Pass::across), {}, {}});
    bindShadows(list, state);
    for (const DrawBatch& batch : state.scene.batches) {
        const MaterialOnDevice& material = state.scene.materialOf(batch);
        list.setPipeline(state.pipelines.compute(material.fibre.acrossShader()));
        material.fibre.bind(list);
        bind(list, {Binding::read(4, batch.colour)});
        dispatchCurvePoints(list, state, batch, shadeConstants(state, material.shading), batch.across);
    }
    list.endPass();
}

}  // namespace hairloom::render
