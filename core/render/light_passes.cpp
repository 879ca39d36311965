// SPDX-License-Identifier: GPL-3.0-or-later
// Curves, shadow maps and shading: what stays while the scene does.
#include <algorithm>
#include <bit>
#include <cmath>

#include "core/render/passes.h"
#include "core/shading/kajiya_kay.h"

namespace hairloom::render {
namespace {

using gpu::Binding;

/// What FibreMaterial::clumping must grow by where the light's map has texels of so many metres. The Sintel
/// strands let as much through as traced ones with 0.86 at 2.2 mm, 1.02 at 1.1 mm and about 1.45 at 0.28 mm;
/// the 0.81 of a beam of 5 mm stands at two texels a beam.
float resolvedClumps(float texel) {
    constexpr float kBeam = 0.0025f, kEachHalving = 0.2f;
    return std::clamp(kEachHalving * std::log2(kBeam / texel), -0.2f, 1.0f);
}

bool castsShadow(const RendererState& state, std::size_t light) {
    return state.options.shadows != Shadows::none && state.lights[light].castsShadow;
}

/// Place of a light's square in the atlas.
std::uint32_t tileOf(const RendererState& state, std::size_t light) {
    std::uint32_t tile = 0;
    for (std::size_t i = 0; i < light; ++i) tile += castsShadow(state, i) ? 1 : 0;
    return tile;
}

/// Pixels in a row of the atlas.
float atlasWidth(const RendererState& state) {
    return static_cast<float>(state.options.shadowResolution * tileOf(state, state.lights.size()));
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

std::uint32_t layerCount(Shadows shadows) {
    return shadows == Shadows::deepOpacity ? 3 : 4;
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
    c.tile = {size * static_cast<float>(tileOf(state, i)), size, head ? 1.0f : 0.0f, atlasWidth(state)};
    c.range = rangeOf(view, hair ? static_cast<std::uint32_t>(state.options.shadows) : 0u);
    c.layers = layersOf(state, view);
    const float distance =
        light.kind == LightKind::point ? view.nearPlane + view.hairStart + 0.5f * view.hairRange : 1.0f;
    const float texel = view.spread * distance / size;
    c.filtering = {resolvedClumps(texel), texel, state.options.headAbsorption, 0};
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

/// Strands into a light's square, with the kernel that is set.
void rasteriseFromLight(gpu::CommandList& list, const RendererState& state, std::size_t light) {
    const std::uint32_t size = state.options.shadowResolution;
    const auto side = static_cast<float>(size);
    shaders::RasterConstants raster;
    raster.window = {static_cast<float>(tileOf(state, light) * size), 0, side, side};
    raster.numbers = {0, 0, static_cast<std::uint32_t>(atlasWidth(state)), 0};
    raster.samples = {1, layerCount(state.options.shadows), 1, 0};
    list.setConstants(0, gpu::bytesOf(lightViewConstants(state, light)));
    dispatchStrands(list, state, raster);
}

void recordFirstHair(gpu::CommandList& list, RendererState& state) {
    list.beginPass({passName(Pass::firstHair), {}, {}});
    fill(list, state, BufferId::firstHair, std::bit_cast<std::uint32_t>(1.0f));
    list.setPipeline(state.pipelines.compute("light_first.comp"));
    bind(list, {Binding::write(0, state.targets[BufferId::firstHair])});
    for (std::size_t i = 0; i < state.lights.size(); ++i) {
        if (castsShadow(state, i)) rasteriseFromLight(list, state, i);
    }
    list.endPass();
}

void recordOpacity(gpu::CommandList& list, RendererState& state) {
    const std::uint32_t size = state.options.shadowResolution;
    list.beginPass({passName(Pass::opacity), {}, {}});
    for (std::size_t i = 0; i < state.lights.size(); ++i) {
        if (!castsShadow(state, i)) continue;
        fill(list, state, BufferId::layerCounts, 0);
        list.setPipeline(state.pipelines.compute("light_layers.comp"));
        bind(list, {Binding::read(2, state.orNothing(BufferId::firstHair)),
                    Binding::write(0, state.targets[BufferId::layerCounts])});
        rasteriseFromLight(list, state, i);
        list.setPipeline(state.pipelines.compute("light_pack.comp"));
        shaders::PackConstants constants;
        const auto mode = static_cast<std::uint32_t>(state.options.shadows);
        constants.size = {size, tileOf(state, i) * size, static_cast<std::uint32_t>(atlasWidth(state)), mode};
        constants.range = rangeOf(state.lightViews[i], mode);
        list.setConstants(0, gpu::bytesOf(constants));
        bind(list, {Binding::read(0, state.orNothing(BufferId::firstHair)),
                    Binding::read(1, state.targets[BufferId::layerCounts]),
                    Binding::write(0, state.targets[BufferId::opacity])});
        list.dispatch((size + 7) / 8, (size + 7) / 8);
    }
    list.endPass();
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
    c.opacity = {material.rootOpacity, material.tipOpacity, 0, 0};
    c.detail = {0.9f * state.detail.share, 1.1f * state.detail.share,
                1 / static_cast<float>(batch.strandCount()), state.detail.widening()};
    return c;
}

/// A linear function of direction is known by its values along some: the least one that has them, damped
/// where lights stand close together, is a sum of these vectors times the values.
void lookAround(const RendererState& state, shaders::ShadeConstants& shade) {
    constexpr float kDamping = 0.05f;
    std::vector<std::size_t> known;
    for (std::size_t i = 0; i < state.lights.size(); ++i) {
        if (castsShadow(state, i) && !state.scene.batches.empty()) known.push_back(i);
    }
    if (known.empty()) return;
    const auto count = static_cast<Eigen::Index>(known.size());
    Eigen::MatrixXf directions(count, 3);
    for (Eigen::Index i = 0; i < count; ++i) {
        const Light& light = state.lights[known[static_cast<std::size_t>(i)]];
        const Vec3f towards = light.kind == LightKind::point
                                  ? Vec3f(light.position_ws - state.scene.hairBounds().center())
                                  : light.toLight_ws;
        directions.row(i) = towards.stableNormalized().transpose();
    }
    const Eigen::MatrixXf overlap =
        directions * directions.transpose() + kDamping * Eigen::MatrixXf::Identity(count, count);
    const Eigen::MatrixXf around = (1 + kDamping) * directions.transpose() * overlap.inverse();
    for (Eigen::Index i = 0; i < count; ++i) {
        const Vec3f vector = around.col(i);
        shade.lights[known[static_cast<std::size_t>(i)]].around =
            toShader(vector, 1 / static_cast<float>(count));
    }
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
    shade.eye_ws = eyeOf(state.camera);
    for (std::size_t i = 0; i < state.environment.coefficients.size(); ++i) {
        shade.environment[i] =
            toShader(state.environment.coefficients[i], state.environment.dark() ? 0.0f : 1.0f);
    }
    shade.ground = toShader(state.scene.groundAlbedo(), 0);
    const HairFlux flux = state.scene.flux();
    shade.sinking = toShader(flux.scattered, flux.clumping);
    shade.turning = toShader(flux.first, flux.ofFibres ? 1.0f : 0.0f);
    shade.straight = toShader(flux.second, 0);
    shade.counts.y = static_cast<std::uint32_t>(state.lights.size());
    for (std::size_t i = 0; i < state.lights.size(); ++i) shade.lights[i] = lightConstants(state, i);
    lookAround(state, shade);
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
    for (const StrandBatch& batch : state.scene.batches) {
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

void recordShadowMaps(gpu::CommandList& list, RendererState& state) {
    if (state.plan.runs(Pass::headDepth)) recordHeadDepth(list, state);
    if (state.plan.runs(Pass::firstHair)) recordFirstHair(list, state);
    if (state.plan.runs(Pass::opacity)) recordOpacity(list, state);
}

void recordShading(gpu::CommandList& list, RendererState& state) {
    list.beginPass({passName(Pass::shade), {}, {}});
    bindShadows(list, state);
    for (const StrandBatch& batch : state.scene.batches) {
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
        constants.counts = {points, constants.counts.y, rows.threads(), 0};
        list.setConstants(0, gpu::bytesOf(constants));
        bind(list, {Binding::read(0, batch.curve), Binding::read(1, batch.headers),
                    Binding::write(0, state.colourOf(batch))});
        list.dispatch(rows.groups, rows.rows);
    }
    list.endPass();
}

}  // namespace hairloom::render
