// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/render/light_grid.h"

#include <algorithm>
#include <cmath>

#include "shaders/shared/light_grid_types.h"

namespace hairloom::render {
namespace {

using gpu::Binding;

/// A cell's whole numbers have room for so many times the hair that there is in the mean, and for so many
/// fibres across a metre at least.
constexpr double kMostHair = 500;
constexpr double kLeastHair = 1000;
/// Hairs side by side across a cell, at least.
constexpr float kFibresAcross = 3;
/// Hairs in a cell from which on their number is hardly left to chance.
constexpr double kManyHairs = 16;
/// Layers of skin in a cell, likewise.
constexpr double kMostSkin = 16;

/// As many cells as `most`, none narrower than `least` metres, around a box; their side is one of few, and
/// they keep their places while hair moves.
LightGridPlace cellsAround(const Box3f& box, std::uint32_t most, float least) {
    const Vec3f extent = box.sizes().cwiseMax(1e-3f);
    // Two cells more along each axis: the box may begin anywhere in the first.
    const auto count = [&](float side) {
        const Vec3f cells = (extent / side).array().ceil() + 2;
        return static_cast<double>(cells.x()) * static_cast<double>(cells.y()) *
               static_cast<double>(cells.z());
    };
    constexpr int kSteps = 8;  // of sides, to twice as long
    int step = static_cast<int>(
        std::floor(kSteps * std::log2(std::cbrt(static_cast<double>(extent.prod()) / most))));
    const auto side = [](int k) { return static_cast<float>(std::exp2(k / static_cast<double>(kSteps))); };
    while (count(side(step)) > most || side(step) < least) ++step;
    LightGridPlace place;
    place.side = side(step);
    for (int axis = 0; axis < 3; ++axis) {
        const auto first = std::floor(box.min()[axis] / place.side);
        const auto end = std::floor(box.max()[axis] / place.side) + 1;
        place.origin_ws[axis] = first * place.side;
        place.size[static_cast<std::size_t>(axis)] = static_cast<std::uint32_t>(end - first);
    }
    return place;
}

/// m² of the sides of a box across each axis, one of two each.
Vec3f sidesOf(const Box3f& box) {
    const Vec3f extent = box.sizes();
    return {extent.y() * extent.z(), extent.z() * extent.x(), extent.x() * extent.y()};
}

/// Light that comes into a box from a lamp, and from around: the channel that has most.
double powerOf(const Light& light, const Box3f& box) {
    const auto caughtFrom = [&](const Vec3f& way) {
        return static_cast<double>(sidesOf(box).dot(way.normalized().cwiseAbs()));
    };
    if (light.kind == LightKind::directional)
        return static_cast<double>(light.irradiance.maxCoeff()) * caughtFrom(light.toLight_ws);
    const double all = 4 * static_cast<double>(kPi);
    const double most = static_cast<double>(light.intensity.maxCoeff());
    if (box.contains(light.position_ws)) return all * most;
    const Vec3f d = light.position_ws - box.center();
    return most * std::min(caughtFrom(d) / std::max(static_cast<double>(d.squaredNorm()), 1e-12), all);
}

double powerOf(const Environment& sky, const Box3f& box) {
    constexpr double kEven = 0.28209479;
    const float area = 2 * sidesOf(box).sum();
    return kEven * static_cast<double>(kPi * area * std::max(sky.coefficients[0].maxCoeff(), 0.0f));
}

shaders::LightGridConstants constantsOf(const RendererState& state) {
    const LightGridPlace& place = state.lightGrid;
    const double side = static_cast<double>(place.side);
    shaders::LightGridConstants c{};
    c.origin_ws = toShader(place.origin_ws, place.side);
    c.skin = toShader(state.scene.groundAlbedo(), 0);
    c.sizeX = place.size[0];
    c.sizeY = place.size[1];
    c.sizeZ = place.size[2];
    c.photons = place.photons;
    const HairMeasure hair = state.scene.measure();
    const double mostHair = std::max(kMostHair * static_cast<double>(hair.fibresPerMetre), kLeastHair);
    c.hairUnit = static_cast<float>(std::exp2(30) / (mostHair * side * side * side));
    c.skinUnit = static_cast<float>(std::exp2(30) / (kMostSkin * side * side));
    // A cell has room for each photon sixteen times.
    c.lightUnit = static_cast<float>(std::min(std::exp2(27) / place.photons, 65536.0));
    c.power = place.power;
    // Where hairs lie at random, a cell holds fewer or more of them by chance, and such cells let more light
    // through than even ones. Hairs count for more by as much.
    const double share = std::max(static_cast<double>(hair.diameter) / side, 1e-6);
    c.clumping = static_cast<float>(share / (1 - std::exp(-share)));
    const double hairs = static_cast<double>(hair.fibresPerMetre) * side / share;
    c.spread = hairs < kManyHairs ? 1.0f : 0.0f;
    std::uint32_t* const before = &c.before[0].x;
    std::copy(place.before.begin(), place.before.end(), before);
    return c;
}

/// A thread for each of `count`, with the kernel that is set.
void dispatch(gpu::CommandList& list, shaders::LightGridConstants constants, std::uint32_t count) {
    const Rows rows(count);
    constants.count = count;
    constants.rowThreads = rows.threads();
    list.setConstants(4, gpu::bytesOf(constants));
    list.dispatch(rows.groups, rows.rows);
}

void addHair(gpu::CommandList& list, RendererState& state, const shaders::LightGridConstants& constants) {
    for (const DrawBatch& batch : state.scene.batches) {
        const MaterialOnDevice& material = state.scene.materialOf(batch);
        const StrandShading& shading = material.shading;
        if (!standsInLightGrid(shading)) continue;
        list.setPipeline(
            state.pipelines.compute(shading.look ? "light_grid_hair_look.comp" : "light_grid_hair.comp"));
        material.fibre.bind(list);
        list.setConstants(4, gpu::bytesOf(constants));
        dispatchCurvePoints(list, state, batch, shadeConstants(state, shading),
                            state.targets[BufferId::lightCells]);
    }
}

void addSkin(gpu::CommandList& list, RendererState& state, const shaders::LightGridConstants& constants) {
    list.setPipeline(state.pipelines.compute("light_grid_skin.comp"));
    for (const MeshOnDevice& mesh : state.scene.meshes) {
        if (mesh.indices.empty()) continue;
        bind(list,
             {Binding::read(0, mesh.drawnPositions()), Binding::read(1, mesh.drawnNormals()),
              Binding::read(2, mesh.indexBuffer), Binding::write(0, state.targets[BufferId::lightCells])});
        dispatch(list, constants, static_cast<std::uint32_t>(mesh.indices.size() / 3));
    }
}

}  // namespace

bool standsInLightGrid(const StrandShading& shading) {
    return !shading.tubes && shading.fibre.model != ShadingModel::kajiya &&
           shading.fibre.scattering != Scattering::single;
}

void placeLightGrid(RendererState& state) {
    state.lightGrid = {};
    const Box3f hair = state.scene.hairBounds();
    if (hair.isEmpty() || !hair.min().allFinite() || !hair.max().allFinite()) return;
    // Skin beside the hair lights it, too.
    const float around = 0.05f * hair.diagonal().norm();
    const Box3f box(hair.min() - Vec3f::Constant(around), hair.max() + Vec3f::Constant(around));
    LightGridPlace place =
        cellsAround(box, state.options.lightCells, kFibresAcross * state.scene.measure().diameter);
    const Vec3f cells(static_cast<float>(place.size[0]), static_cast<float>(place.size[1]),
                      static_cast<float>(place.size[2]));
    const Box3f lit(place.origin_ws, place.origin_ws + place.side * cells);
    std::vector<double> powers;
    for (const Light& light : state.lights) powers.push_back(light.castsShadow ? powerOf(light, lit) : 0);
    powers.push_back(powerOf(state.environment, lit));
    double all = 0;
    for (const double power : powers) all += power;
    if (!(all > 0)) return;
    place.photons = state.options.lightPhotons / (state.options.temporal ? 2 : 1);
    place.power = static_cast<float>(all / place.photons);
    double sum = 0;
    for (std::size_t i = 0; i < powers.size(); ++i) {
        place.before[i] = static_cast<std::uint32_t>(std::lround(sum / all * place.photons));
        sum += powers[i];
    }
    for (std::size_t i = powers.size(); i < place.before.size(); ++i) place.before[i] = place.photons;
    state.lightGrid = place;
}

void recordLightGrid(gpu::CommandList& list, RendererState& state) {
    if (!(state.lightGrid.side > 0)) return;
    const shaders::LightGridConstants constants = constantsOf(state);
    const Targets& t = state.targets;
    const std::uint32_t cells = constants.sizeX * constants.sizeY * constants.sizeZ;
    list.beginPass({passName(Pass::lightGrid), {}, {}});
    fill(list, state, BufferId::lightCells, 0);
    fill(list, state, BufferId::lightSums, 0);
    addHair(list, state, constants);
    addSkin(list, state, constants);
    list.setPipeline(state.pipelines.compute("light_grid_trace.comp"));
    list.setConstants(0, gpu::bytesOf(state.shade));
    bind(list, {Binding::read(0, t[BufferId::lightCells]),
                Binding::read(8, state.orPlaceholder(TargetId::headDepth)),
                Binding::write(0, t[BufferId::lightSums])});
    dispatch(list, constants, constants.photons);
    list.setPipeline(state.pipelines.compute("light_grid_show.comp"));
    bind(list, {Binding::read(0, t[BufferId::lightCells]), Binding::read(1, t[BufferId::lightSums]),
                Binding::write(0, t[BufferId::lightGrid])});
    dispatch(list, constants, cells);
    list.endPass();
}

}  // namespace hairloom::render
