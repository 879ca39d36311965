// SPDX-License-Identifier: MIT
#include "models/rods/rods.h"

#include <algorithm>
#include <cmath>

#include "engine/moving_body.h"

namespace hairloom::runtime {
namespace {

/// Of a vertex whose outer segment is turned so from its inner one; where there are strains.
void setStrain(const RodView& rod, std::size_t i, Quat turn) {
    if (!rod.strain.x) return;
    const float twice = turn.w < 0.0f ? -2.0f : 2.0f;
    for (const Planes& strain : {rod.strain, rod.strainBefore}) {
        strain.x[i] = twice * turn.x;
        strain.y()[i] = twice * turn.y;
        strain.z()[i] = twice * turn.z;
    }
}

}  // namespace

std::size_t RodRest::planeCount() const {
    return kRodRestPlanes[static_cast<std::size_t>(parts)];
}

RodTouches rodTouchesOf(const State& state) {
    return {!state.own[kOwnLoads].empty(), !state.own[kOwnFolds].empty()};
}

void allocateRods(const RestShape& shape, RodParts parts, RodTouches touches, State& state,
                  const Host& host) {
    keepFloats(state.own[kOwnMotion], shape.planeFloats * kRodMotionPlanes, host);
    keepFloats(state.own[kOwnStrains], parts == RodParts::chain ? 0 : shape.planeFloats * kRodStrainPlanes,
               host);
    keepFloats(state.own[kOwnLoads], touches.loads ? shape.planeFloats : 0, host);
    keepFloats(state.own[kOwnFolds], touches.folds ? shape.planeFloats * kFoldPlanes : 0, host);
    keepFloats(state.own[kOwnLanes], shape.blocks.size() * kRodLaneRows * kBlockLanes);
}

void placeRodAtRest(const RestShape& shape, const RodRest& rest, State& state, std::size_t index,
                    LaneRange lanes) {
    const Block& block = shape.blocks[index];
    const float* const roots = state.roots.data() + index * kRootRows * kBlockLanes;
    const RodView rod = rodViewOf(shape, rest, state, index);
    const std::size_t size = planeSize(block);
    Quat root[kBlockLanes], inner[kBlockLanes];
    for (std::uint32_t lane = lanes.begin; lane < lanes.end; ++lane) {
        const auto row = [&](std::size_t r) { return roots[r * kBlockLanes + lane]; };
        root[lane] = inner[lane] = {row(3), row(4), row(5), row(6)};
        rod.turn[lane] = kRodNoStep;
        rod.energy[lane] = kRodNoEnergy;
    }
    // Point by point, since lanes share their lines of the cache.
    for (std::uint32_t p = 0; p < block.points; ++p) {
        const auto clear = [&](float* plane) {
            float* const row = plane + std::size_t{p} * kBlockLanes;
            std::fill(row + lanes.begin, row + lanes.end, 0.0f);
        };
        for (std::size_t plane = 4; plane < kRodMotionPlanes; ++plane) clear(rod.rotation + plane * size);
        if (rod.load) clear(rod.load);
        for (std::size_t plane = 0; rod.fold && plane < kFoldPlanes; ++plane) clear(rod.fold + plane * size);
        for (std::uint32_t lane = lanes.begin; lane < lanes.end; ++lane) {
            const std::size_t i = std::size_t{p} * kBlockLanes + lane;
            Quat q = root[lane];
            if (rod.restRotation && p + 1 < block.points) {
                const float* const at = rod.restRotation + i;
                q = q * Quat{at[0], at[size], at[2 * size], at[3 * size]};
            }
            normalize(q);
            const float values[] = {q.x, q.y, q.z, q.w};
            for (std::size_t plane = 0; plane < 4; ++plane) rod.rotation[plane * size + i] = values[plane];
            setStrain(rod, i, p + 1 < block.points ? conjugate(inner[lane]) * q : Quat{});
            inner[lane] = q;
        }
    }
}

void placeRodOnPoints(const RestShape& shape, const RodRest& rest, State& state, std::size_t index,
                      std::uint32_t lane) {
    placeRodAtRest(shape, rest, state, index, lane);
    const Block& block = shape.blocks[index];
    const RodView rod = rodViewOf(shape, rest, state, index);
    const std::size_t size = planeSize(block);
    const float* const moving = state.planes.data() + block.firstPlane * kStatePlanes;
    const float rate = state.substep > 0.0f ? 1.0f / state.substep : 0.0f;
    const auto position = [&](std::uint32_t p) {
        const std::size_t i = std::size_t{p} * kBlockLanes + lane;
        return Float3{moving[i], moving[size + i], moving[2 * size + i]};
    };
    const float* const roots = state.roots.data() + index * kRootRows * kBlockLanes;
    const auto row = [&](std::size_t r) { return roots[r * kBlockLanes + lane]; };
    const Quat root{row(3), row(4), row(5), row(6)};
    Quat atRestBefore, before;
    for (std::uint32_t p = 0; p < block.points; ++p) {
        const std::size_t i = std::size_t{p} * kBlockLanes + lane;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const float moved = moving[axis * size + i] - moving[(axis + 3) * size + i];
            rod.displacement.x[axis * size + i] = moved;
            rod.velocity.x[axis * size + i] = rod.velocityBefore.x[axis * size + i] = moved * rate;
        }
        if (p + 1 == block.points) break;
        const Quat atRest{rod.rotation[i], rod.rotation[size + i], rod.rotation[2 * size + i],
                          rod.rotation[3 * size + i]};
        Quat q = p == 0 ? atRest : before * (conjugate(atRestBefore) * atRest);
        const Float3 edge = position(p + 1) - position(p);
        const float long_ = length(edge);
        if (long_ > 1e-9f) {
            const Float3 now = rotate(q, {rod.tangent.x[i], rod.tangent.y()[i], rod.tangent.z()[i]}),
                         wanted = edge * (1.0f / long_);
            const Float3 axis = cross(now, wanted);
            const float c = dot(now, wanted);
            Quat turn{axis.x, axis.y, axis.z, 1.0f + c};
            if (c < -0.9999f) {
                const Float3 any =
                    cross(now, std::abs(now.x) < 0.8f ? Float3{1.0f, 0.0f, 0.0f} : Float3{0.0f, 1.0f, 0.0f});
                turn = {any.x, any.y, any.z, 0.0f};
            }
            normalize(turn);
            q = turn * q;
            normalize(q);
        }
        const float values[] = {q.x, q.y, q.z, q.w};
        for (std::size_t plane = 0; plane < 4; ++plane) rod.rotation[plane * size + i] = values[plane];
        setStrain(rod, i, conjugate(p > 0 ? before : root) * q);
        atRestBefore = atRest;
        before = q;
    }
}

namespace {

/// The strains of lane `lane` of block `index` where it is.
void strainRod(const RestShape& shape, const RodRest& rest, State& state, std::size_t index,
               std::uint32_t lane) {
    const Block& block = shape.blocks[index];
    const RodView rod = rodViewOf(shape, rest, state, index);
    const std::size_t size = planeSize(block);
    const float* const roots = state.roots.data() + index * kRootRows * kBlockLanes;
    const auto row = [&](std::size_t r) { return roots[r * kBlockLanes + lane]; };
    Quat inner{row(3), row(4), row(5), row(6)};
    for (std::uint32_t p = 0; p + 1 < block.points; ++p) {
        const std::size_t i = std::size_t{p} * kBlockLanes + lane;
        const Quat q{rod.rotation[i], rod.rotation[size + i], rod.rotation[2 * size + i],
                     rod.rotation[3 * size + i]};
        setStrain(rod, i, conjugate(inner) * q);
        inner = q;
    }
}

}  // namespace

void completeRods(const RestShape& shape, const RodRest& rest, RodTouches touches, State& state) {
    if (state.model != StrandModel::rods) state.own = {};
    state.model = StrandModel::rods;
    const bool wereRods = state.own[kOwnMotion].size() == shape.planeFloats * kRodMotionPlanes;
    const bool hadStrains = !state.own[kOwnStrains].empty();
    allocateRods(shape, rest.parts, touches, state);
    if (wereRods && (hadStrains || rest.parts == RodParts::chain)) return;
    for (std::size_t b = 0; b < shape.blocks.size(); ++b) {
        for (std::uint32_t lane = 0; lane < kBlockLanes; ++lane)
            wereRods ? strainRod(shape, rest, state, b, lane) : placeRodOnPoints(shape, rest, state, b, lane);
    }
}

void forgetRodEnergy(const RestShape& shape, State& state) {
    for (std::size_t b = 0; b < shape.blocks.size(); ++b) {
        float* const energy = state.own[kOwnLanes].data() + (b * kRodLaneRows + 1) * kBlockLanes;
        std::fill_n(energy, kBlockLanes, kRodNoEnergy);
    }
}

RodView rodViewOf(const RestShape& shape, const RodRest& rest, State& state, std::size_t index) {
    RodView view;
    const Block& block = shape.blocks[index];
    const std::size_t size = planeSize(block);
    const float* const fixed = rest.planes.data() + block.firstPlane * rest.planeCount();
    float* const moving = state.own[kOwnMotion].data() + block.firstPlane * kRodMotionPlanes;
    const auto three = [&](std::size_t plane) { return Planes{moving + plane * size, size}; };
    view.tangent = {fixed, size};
    view.mass = fixed + kRodMassPlane * size;
    if (rest.parts >= RodParts::bending) {
        view.bend = fixed + kRodBendPlane * size;
        view.restRotation = fixed + kRodRotationPlane * size;
        float* const strains = state.own[kOwnStrains].data() + block.firstPlane * kRodStrainPlanes;
        view.strain = {strains, size};
        view.strainBefore = {strains + 3 * size, size};
    }
    if (rest.parts >= RodParts::twist) {
        view.axis = {fixed + kRodAxisPlane * size, size};
        view.curved = rest.curved[index] != 0;
    }
    if (rest.parts >= RodParts::section) view.normal = {fixed + kRodNormalPlane * size, size};
    view.rotation = moving;
    view.increment = three(4);
    view.displacement = three(7);
    view.velocity = three(10);
    view.velocityBefore = three(13);
    if (!state.own[kOwnLoads].empty()) view.load = state.own[kOwnLoads].data() + block.firstPlane;
    if (!state.own[kOwnFolds].empty())
        view.fold = state.own[kOwnFolds].data() + block.firstPlane * kFoldPlanes;
    view.turn = state.own[kOwnLanes].data() + index * kRodLaneRows * kBlockLanes;
    view.energy = view.turn + kBlockLanes;
    return view;
}

}  // namespace hairloom::runtime
