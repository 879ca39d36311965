// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/render/shadow_maps.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/base/parallel.h"
#include "core/render/opacity_layers.h"

namespace hairloom::render {
namespace {

using gpu::Binding;

bool castsShadow(const RendererState& state, std::size_t light) {
    return state.options.shadows != Shadows::none && state.lights[light].castsShadow;
}

/// Ends of layers in metres: of all where there are few, else the last alone, from which the others follow.
shaders::float4 layersOf(const RendererState& state, const ShadowAtlas& atlas, const LightView& view) {
    const float range = view.hairRange;
    const auto end = [&](std::uint32_t i) { return layerEnd(i, atlas.layerCount, atlas.growth) * range; };
    switch (atlas.shadows) {
        case Shadows::deepOpacity:
            if (state.deepLayers) {
                const auto& ends = *state.deepLayers;
                return {ends[0] * range, ends[1] * range, ends[2] * range, 0};
            }
            if (atlas.layerCount > 3) return {0, 0, range, 0};
            return {end(0), end(1), end(2), 0};
        case Shadows::opacityMaps:
            if (atlas.layerCount != 4) return {0, 0, 0, range};
            return {0.25f * range, 0.5f * range, 0.75f * range, range};
        case Shadows::absorption: {
            const HairMeasure measure = state.scene.measure();
            return {measure.fibresPerMetre, measure.fibresThrough, 0, 0};
        }
        case Shadows::adaptive:
        case Shadows::none:
            break;
    }
    return {};
}

/// For drawing strands into a square.
shaders::ViewConstants squareConstants(const RendererState& state, const ShadowAtlas& atlas,
                                       std::size_t square) {
    const LightView& view = *atlas.views[square];
    shaders::ViewConstants c{};
    c.clipFromWorld = toShader(view.clipFromWorld);
    c.eye_ws = {view.eye_ws.x(), view.eye_ws.y(), view.eye_ws.z(), view.eye_ws.w()};
    c.pixelSize = view.spread / static_cast<float>(atlas.side);
    c.minWidth = 1;
    c.fibresForEach = 1 / atlas.share;
    c.eachHair = square + atlas.close >= atlas.views.size() ? 1 : 0;
    c.samples = 1;
    c.shadows = static_cast<std::uint32_t>(atlas.shadows);
    c.layers = layersOf(state, atlas, view);
    c.depthRange = view.depthRange;
    c.nearPlane = view.nearPlane;
    c.hairBegins = view.hairStart;
    return c;
}

/// Strands into a square, with the kernel that is set.
void rasterise(gpu::CommandList& list, const RendererState& state, const ShadowAtlas& atlas,
               std::size_t square, std::uint32_t phase = 0) {
    const auto side = static_cast<float>(atlas.side);
    shaders::RasterConstants raster{};
    raster.window = {static_cast<float>(atlas.left(square)), 0, side, side};
    raster.bufferWidth = atlas.width();
    raster.samples = 1;
    raster.layers = atlas.layerCount;
    raster.layerGrowth = atlas.growth;
    raster.slices = 1;
    raster.phase = phase;
    raster.square = static_cast<std::uint32_t>(square);
    if (const gpu::BufferPtr& lists = state.targets[BufferId::lightFragments])
        raster.fragments = static_cast<std::uint32_t>(lists->desc().size / (4 * HAIRLOOM_LISTED_WORDS));
    list.setConstants(0, gpu::bytesOf(squareConstants(state, atlas, square)));
    dispatchStrands(list, state, raster, atlas.share);
}

void recordFirstHair(gpu::CommandList& list, RendererState& state, const ShadowAtlas& atlas) {
    list.beginPass({passName(atlas.firstPass), {}, {}});
    fill(list, state, atlas.first, std::bit_cast<std::uint32_t>(1.0f));
    list.setPipeline(state.pipelines.compute("light_first.comp"));
    bind(list, {Binding::write(0, state.targets[atlas.first])});
    for (std::size_t i = 0; i < atlas.views.size(); ++i) rasterise(list, state, atlas, i);
    list.endPass();
}

shaders::PackConstants packConstants(const ShadowAtlas& atlas, std::size_t square) {
    shaders::PackConstants constants{};
    constants.side = atlas.side;
    constants.tileLeft = atlas.left(square);
    constants.atlasWidth = atlas.width();
    constants.shadows = static_cast<std::uint32_t>(atlas.shadows);
    constants.depthRange = atlas.views[square]->depthRange;
    constants.nearPlane = atlas.views[square]->nearPlane;
    constants.layers = atlas.layerCount;
    constants.words = opacityWords(atlas.shadows, atlas.layerCount);
    return constants;
}

/// Lists of what each texel has, and nodes from them: a light after the other, for lists take much memory.
void recordNodes(gpu::CommandList& list, RendererState& state, const ShadowAtlas& atlas) {
    const std::uint32_t groups = groupsFor(atlas.side, HAIRLOOM_TILE_GROUP);
    const Targets& t = state.targets;
    list.beginPass({passName(atlas.layersPass), {}, {}});
    fill(list, state, BufferId::fragmentCounts, 0);
    for (std::size_t i = 0; i < atlas.views.size(); ++i) {
        fill(list, state, atlas.counts, 0);
        list.setPipeline(state.pipelines.compute("light_link.comp"));
        bind(list, {Binding::write(0, t[BufferId::fragmentCounts]), Binding::write(1, t[atlas.counts]),
                    Binding::write(2, t[BufferId::lightFragments])});
        rasterise(list, state, atlas, i, HAIRLOOM_PHASE_COUNT);
        rasterise(list, state, atlas, i, HAIRLOOM_PHASE_LINK);
        list.setPipeline(state.pipelines.compute("light_nodes.comp"));
        list.setConstants(0, gpu::bytesOf(packConstants(atlas, i)));
        bind(list, {Binding::read(0, t[atlas.counts]), Binding::write(0, t[BufferId::lightFragments]),
                    Binding::write(1, t[atlas.layers])});
        list.dispatch(groups, groups);
    }
    list.endPass();
}

void recordLayers(gpu::CommandList& list, RendererState& state, const ShadowAtlas& atlas) {
    const std::uint32_t groups = groupsFor(atlas.side, HAIRLOOM_TILE_GROUP);
    list.beginPass({passName(atlas.layersPass), {}, {}});
    for (std::size_t i = 0; i < atlas.views.size(); ++i) {
        fill(list, state, atlas.counts, 0);
        list.setPipeline(state.pipelines.compute("light_layers.comp"));
        bind(list, {Binding::read(2, state.orPlaceholder(atlas.first)),
                    Binding::write(0, state.targets[atlas.counts])});
        rasterise(list, state, atlas, i);
        list.setPipeline(state.pipelines.compute("light_pack.comp"));
        list.setConstants(0, gpu::bytesOf(packConstants(atlas, i)));
        bind(list,
             {Binding::read(0, state.orPlaceholder(atlas.first)),
              Binding::read(1, state.targets[atlas.counts]), Binding::write(0, state.targets[atlas.layers])});
        list.dispatch(groups, groups);
    }
    list.endPass();
}

void recordHeadDepth(gpu::CommandList& list, RendererState& state, const ShadowAtlas& atlas) {
    list.beginPass({passName(atlas.headPass), {}, {state.targets[atlas.head], gpu::LoadOp::Clear, 1}});
    list.setPipeline(state.pipelines.graphics(kMeshDepth));
    const auto side = static_cast<float>(atlas.side);
    for (std::size_t i = 0; i < atlas.views.size(); ++i) {
        const std::uint32_t left = atlas.left(i);
        list.setViewport({static_cast<float>(left), 0, side, side, 0, 1});
        list.setScissor({left, 0, atlas.side, atlas.side});
        shaders::MeshConstants constants{};
        constants.clipFromWorld = toShader(atlas.views[i]->clipFromWorld);
        list.setConstants(1, gpu::bytesOf(constants));
        drawMeshes(list, state);
    }
    list.endPass();
}

float filterTexels(ShadowFilter filter) {
    return filter == ShadowFilter::off ? 1.0f : filter == ShadowFilter::three ? 3.0f : 5.0f;
}

shaders::LightConstants viewOf(const LightView& view) {
    shaders::LightConstants c{};
    c.clipFromWorld = toShader(view.clipFromWorld);
    c.toLight_ws = {view.eye_ws.x(), view.eye_ws.y(), view.eye_ws.z(), view.eye_ws.w()};
    return c;
}

/// Points of hair, or the corners of everything where there is none.
std::vector<Vec3f> pointsToFit(const RendererState& state, const Box3f& all) {
    std::vector<Vec3f> points = state.scene.sample();
    const bool none = points.empty();
    for (int i = 0; i < 8 && none && !all.isEmpty(); ++i) {
        points.push_back(all.corner(static_cast<Box3f::CornerType>(i)));
    }
    return points;
}

/// Corners of an icosahedron.
const std::array<Vec3f, HAIRLOOM_SKY_MAPS> kSkyDirections = [] {
    const float golden = 0.5f * (1 + std::sqrt(5.0f));
    std::array<Vec3f, HAIRLOOM_SKY_MAPS> directions;
    for (int i = 0; i < HAIRLOOM_SKY_MAPS; ++i) {
        const int axis = i / 4;
        Vec3f& d = directions[static_cast<std::size_t>(i)];
        d[axis] = 0;
        d[(axis + 1) % 3] = i % 2 == 0 ? 1.0f : -1.0f;
        d[(axis + 2) % 3] = i % 4 < 2 ? golden : -golden;
        d.normalize();
    }
    return directions;
}();

/// What of everything lies near hair.
Box3f aroundHair(const RendererState& state, const Box3f& all) {
    const Box3f hair = state.scene.hairBounds();
    if (hair.isEmpty()) return all;
    const Vec3f around = Vec3f::Constant(0.5f * hair.diagonal().norm());
    return Box3f(hair.min() - around, hair.max() + around).intersection(all);
}

void fitSky(RendererState& state, std::span<const Vec3f> fitted, const Box3f& all) {
    const bool wanted = state.plan.runs(Pass::skyHead) || state.plan.runs(Pass::skyLayers);
    state.skyViews.resize(wanted ? kSkyDirections.size() : 0);
    const Box3f near = aroundHair(state, all);
    parallelFor(state.skyViews.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            Light sky;
            sky.toLight_ws = kSkyDirections[i];
            state.skyViews[i] = fitLight(sky, fitted, all, near);
        }
    });
    const ShadowAtlas atlas = skyAtlas(state);
    for (std::size_t i = 0; i < atlas.views.size(); ++i) state.sky.maps[i] = mapConstants(state, atlas, i);
}

}  // namespace

void fitViews(RendererState& state, bool sky) {
    const Box3f all = state.bounds();
    const std::vector<Vec3f> fitted = pointsToFit(state, all);
    state.lightViews.resize(state.lights.size());
    parallelFor(state.lights.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            state.lightViews[i] = fitLight(state.lights[i], fitted, all);
    });
    if (sky) fitSky(state, fitted, all);
}

ShadowAtlas lightAtlas(const RendererState& state) {
    ShadowAtlas atlas;
    atlas.side = state.options.shadowResolution;
    atlas.shadows = state.options.shadows;
    atlas.layerCount = layerCount(state.options);
    atlas.growth = growthOf(state.options);
    atlas.filterTexels = filterTexels(state.options.shadowFilter);
    for (std::size_t i = 0; i < state.lightViews.size(); ++i) {
        if (castsShadow(state, i)) atlas.views.push_back(&state.lightViews[i]);
    }
    for (const LightView& view : state.closeViews) atlas.views.push_back(&view);
    atlas.close = state.closeViews.size();
    return atlas;
}

ShadowAtlas skyAtlas(const RendererState& state) {
    ShadowAtlas atlas;
    atlas.side = kSkyResolution;
    atlas.shadows = Shadows::deepOpacity;
    atlas.head = TargetId::skyHead;
    atlas.first = BufferId::skyFirst;
    atlas.counts = BufferId::skyCounts;
    atlas.layers = BufferId::skyLayers;
    atlas.headPass = Pass::skyHead;
    atlas.firstPass = Pass::skyFirst;
    atlas.layersPass = Pass::skyLayers;
    for (const LightView& view : state.skyViews) atlas.views.push_back(&view);
    std::uint32_t strands = 0;
    for (const DrawBatch& batch : state.scene.batches) strands += batch.strandCount(state.detail);
    const auto maximum = static_cast<float>(state.options.skyStrands);
    atlas.share = std::min(1.0f, maximum / static_cast<float>(std::max(strands, 1u)));
    return atlas;
}

namespace {

/// How much of the light that meets fibres a texel's count stops. Where hairs are wider than they are, so
/// that each stands for several, counts come in larger portions: as many at random let through more light, by
/// the convexity of exp(-n), unless they stop more.
void setFilter(shaders::LightConstants& c, float texels, float hairTexels, float widening) {
    c.filterTexels = texels;
    if (!(widening > 1)) return;
    // Where hairs begin to grow wider the change is gradual.
    const float share = 4 * (widening - 1);
    c.tapDistance = share < 1 ? share : std::max(hairTexels * widening, 1.0f);
    // Mean sum of the squares of a B-spline's weights across a hair; along it all texels see the same hair.
    const float kept = texels < 2 ? 1.0f : texels < 4 ? 0.55f : 0.43f;
    const auto stopped = [](float stopping, float portion) {
        return (1 - std::exp(-stopping * portion)) / portion;
    };
    const float own = std::clamp(hairTexels, 1e-4f, 1.0f);
    const float portion = std::max(std::min(hairTexels * widening, 1.0f) * kept, own);
    c.stopping = -std::log(std::max(1 - portion * stopped(c.stopping, own), 0.02f)) / portion;
}

}  // namespace

shaders::LightConstants mapConstants(const RendererState& state, const ShadowAtlas& atlas,
                                     std::size_t square) {
    const LightView& view = *atlas.views[square];
    const bool hair = !state.scene.batches.empty();
    const auto side = static_cast<float>(atlas.side);
    shaders::LightConstants c = viewOf(view);
    c.tileLeft = static_cast<float>(atlas.left(square));
    c.tileSize = side;
    c.headCasts = state.plan.runs(atlas.headPass) ? 1.0f : 0.0f;
    c.atlasWidth = static_cast<float>(atlas.width());
    c.depthRange = view.depthRange;
    c.shadows = hair ? static_cast<float>(atlas.shadows) : 0.0f;
    c.nearPlane = view.nearPlane;
    c.hairBegins = view.hairStart;
    c.layers = layersOf(state, atlas, view);
    c.layerCount = static_cast<float>(atlas.layerCount);
    c.layerGrowth = atlas.growth;
    const float distance =
        view.eye_ws.w() > 0 ? view.nearPlane + view.hairStart + 0.5f * view.hairRange : 1.0f;
    const float texel = view.spread * distance / side;
    const float widening = state.mapDetail.widening();
    const float hairTexels = state.scene.measure().diameter / texel;
    if (atlas.shadows == Shadows::deepOpacity) c.layers.w = std::min(hairTexels * widening, 1.0f);
    c.stopping = state.scene.clumping.of(texel);
    c.texelSize = texel;
    c.headAbsorption = state.options.headAbsorption;
    setFilter(c, atlas.filterTexels, hairTexels, widening);
    return c;
}

shaders::LightConstants lightConstants(const RendererState& state, std::size_t light) {
    shaders::LightConstants c = viewOf(state.lightViews[light]);
    if (castsShadow(state, light)) {
        std::size_t square = 0;
        for (std::size_t i = 0; i < light; ++i) square += castsShadow(state, i) ? 1 : 0;
        c = mapConstants(state, lightAtlas(state), square);
        // One that is no finer tells nothing.
        if (square < state.closeViews.size() &&
            state.closeViews[square].spread < state.lightViews[light].spread) {
            c.closeMap = static_cast<float>(square);
            c.closeShare = state.closeHair.maps;
        }
    }
    const Light& source = state.lights[light];
    const bool point = source.kind == LightKind::point;
    c.irradiance = toShader(point ? source.intensity : source.irradiance, 0);
    c.facing_ws = toShader(point ? source.facing_ws : Vec3f(Vec3f::Zero()), 0);
    return c;
}

shaders::LightConstants closeMapConstants(const RendererState& state, std::size_t map) {
    const ShadowAtlas atlas = lightAtlas(state);
    shaders::LightConstants c = mapConstants(state, atlas, atlas.views.size() - atlas.close + map);
    const float hair = std::max(state.scene.measure().diameter, 1e-6f);
    // How hair clumps in a beam matters less the more of it a texel resolves, down to one hair.
    const float measured = Clumping::kWidths.back();
    const float resolved =
        c.texelSize <= hair
            ? 1.0f
            : std::clamp(std::log(measured / c.texelSize) / std::log(std::max(measured / hair, 1.01f)), 0.0f,
                         1.0f);
    c.stopping += (1 - c.stopping) * resolved;
    // A texel counts whole fibres or none of them: exp(-s p n / p) of n / p fibres at random, each p of a
    // texel, is exp(-n) in the mean where (1 - exp(-s p)) / p is 1.
    const float part = std::clamp(hair / c.texelSize, 1e-3f, 0.98f);
    c.stopping *= -std::log(1 - part) / part;
    return c;
}

void recordMaps(gpu::CommandList& list, RendererState& state, const ShadowAtlas& atlas) {
    if (state.plan.runs(atlas.headPass)) recordHeadDepth(list, state, atlas);
    if (state.plan.runs(atlas.firstPass)) recordFirstHair(list, state, atlas);
    if (!state.plan.runs(atlas.layersPass)) return;
    if (atlas.shadows == Shadows::adaptive) return recordNodes(list, state, atlas);
    recordLayers(list, state, atlas);
}

}  // namespace hairloom::render
