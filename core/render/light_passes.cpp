// SPDX-License-Identifier: GPL-3.0-or-later
// Curves, what they see of the sky, and shading: what stays while the scene does.
#include <cmath>

#include "core/render/passes.h"
#include "core/render/shadow_maps.h"
#include "core/shading/kajiya_kay.h"

namespace hairloom::render {
namespace {

using gpu::Binding;

shaders::CurveConstants curveConstants(const RendererState& state, const DrawBatch& batch) {
    const StrandGroup& group = state.scene.groups[batch.group];
    const bool own = group.devicePositions == nullptr;
    const HairMaterial& material = group.material;
    shaders::CurveConstants c;
    c.strandCount = batch.strandCount(state.detail);
    c.subdivisions = state.detail.subdivisions;
    c.floatsPerPoint = own ? 3 : group.floatsPerPoint;
    c.strandMajor = own ? 0 : static_cast<std::uint32_t>(group.strandCount);
    c.radius = {material.radius, material.tipScale, group.hasRadii ? 1.0f : 0.0f, material.radiusVariation};
    c.opacity = {material.rootOpacity, material.tipOpacity, 0, 0};
    c.detail = {0.9f * state.detail.share, 1.1f * state.detail.share,
                1 / static_cast<float>(batch.strandCount()), state.detail.widening()};
    return c;
}

}  // namespace

void setUpLights(RendererState& state) {
    shaders::ShadeConstants& shade = state.shade;
    shade.eye_ws = eyeOf(state.camera);
    for (std::size_t i = 0; i < state.environment.coefficients.size(); ++i) {
        shade.environment[i] = toShader(state.environment.coefficients[i], 0);
    }
    shade.environment[0].w = state.environment.dark() ? 0.0f : 1.0f;
    shade.environment[1].w = state.plan.runs(Pass::skyHead) || state.plan.runs(Pass::skyLayers) ? 1.0f : 0.0f;
    shade.ground = toShader(state.scene.groundAlbedo(), 0);
    const HairFlux flux = state.scene.flux();
    shade.sinking = toShader(flux.scattered, flux.clumping);
    shade.turning = toShader(flux.first, flux.ofFibres ? 1.0f : 0.0f);
    shade.straight = toShader(flux.second, 0);
    shade.counts.y = static_cast<std::uint32_t>(state.lights.size());
    for (std::size_t i = 0; i < state.lights.size(); ++i) shade.lights[i] = lightConstants(state, i);
}

shaders::ShadeConstants lightsOfFrame(const RendererState& state) {
    shaders::ShadeConstants c = state.shade;
    for (shaders::LightConstants& light : c.lights) light.filtering.w = state.lit ? 1.0f : 0.0f;
    return c;
}

shaders::ShadeConstants shadeConstants(const RendererState& state, const HairMaterial& m) {
    shaders::ShadeConstants c = lightsOfFrame(state);
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

shaders::LookConstants lookConstants(const shading::StrandLook& look) {
    const auto pack = [](const Vec3d& v, double w) {
        return toShader(v.cast<float>(), static_cast<float>(w));
    };
    const bool absorbs = look.quantity == shading::LookQuantity::absorption;
    shaders::LookConstants c;
    c.root = pack(look.root, look.gradient.start);
    c.tip = pack(look.tip, look.gradient.scale);
    c.streakRoot = pack(look.streakRoot, look.spread);
    c.streakTip = pack(look.streakTip, absorbs ? 1 : 0);
    c.dye = pack(look.dye, look.ownScale);
    c.along = {static_cast<float>(look.dyeAlong.start), static_cast<float>(look.dyeAlong.scale), 0, 0};
    c.emissionRoot = pack(look.emissionRoot, 0);
    c.emissionTip = pack(look.emissionTip, 0);
    return c;
}

void recordCurves(gpu::CommandList& list, RendererState& state) {
    list.beginPass({passName(Pass::curves), {}, {}});
    list.setPipeline(state.pipelines.compute("curve.comp"));
    for (const DrawBatch& batch : state.scene.batches) {
        const StrandGroup& group = state.scene.groups[batch.group];
        const shaders::CurveConstants constants = curveConstants(state, batch);
        list.setConstants(0, gpu::bytesOf(constants));
        bind(list, {Binding::read(0, batch.headers),
                    Binding::read(1, group.devicePositions ? group.devicePositions : batch.positions),
                    Binding::read(2, batch.radii), Binding::write(0, batch.curve)});
        list.dispatch((constants.strandCount + 63) / 64);
    }
    list.endPass();
}

void recordSkySeen(gpu::CommandList& list, RendererState& state) {
    list.beginPass({passName(Pass::skySeen), {}, {}});
    list.setPipeline(state.pipelines.compute("sky_seen.comp"));
    bindShadows(list, state);
    constexpr std::uint32_t kGroup = 64, kThreadsOfAStrand = 16;
    shaders::ShadeConstants constants = state.shade;
    for (const DrawBatch& batch : state.scene.batches) {
        const std::uint32_t strands = batch.strandCount(state.detail);
        constants.counts = {strands, 0, 0, state.detail.subdivisions};
        list.setConstants(0, gpu::bytesOf(constants));
        bind(list,
             {Binding::read(0, batch.curve), Binding::read(1, batch.headers), Binding::write(0, batch.seen)});
        list.dispatch((strands + kGroup - 1) / kGroup, kThreadsOfAStrand);
    }
    list.endPass();
}

void recordShading(gpu::CommandList& list, RendererState& state) {
    list.beginPass({passName(Pass::shade), {}, {}});
    bindShadows(list, state);
    for (const DrawBatch& batch : state.scene.batches) {
        const StrandGroup& group = state.scene.groups[batch.group];
        const char* const tube = group.material.look ? "tube_albedo_look.comp" : "tube_albedo.comp";
        list.setPipeline(state.pipelines.compute(group.material.tubes ? tube : group.fibre.shader()));
        if (!group.material.tubes) group.fibre.bind(list);
        if (group.material.look) {
            list.setConstants(2, gpu::bytesOf(lookConstants(*group.material.look)));
            bind(list, {Binding::read(2, batch.pointDyes)});
        }
        auto constants = shadeConstants(state, group.material);
        const std::uint32_t points =
            batch.curvePoints(batch.strandCount(state.detail), state.detail.subdivisions);
        const Rows rows(points);
        constants.counts = {points, constants.counts.y, rows.threads(), state.detail.subdivisions};
        list.setConstants(0, gpu::bytesOf(constants));
        bind(list, {Binding::read(0, batch.curve), Binding::read(1, batch.headers),
                    Binding::read(3, batch.seen ? batch.seen : state.noSky),
                    Binding::write(0, state.colourOf(batch))});
        list.dispatch(rows.groups, rows.rows);
    }
    list.endPass();
}

}  // namespace hairloom::render
