// SPDX-License-Identifier: MIT
#include "models/rods/rods.h"

#include <algorithm>
#include <cmath>

namespace hairloom::runtime {

void placeRodAtRest(const RestShape& shape, const RodRest& rest, State& state, std::size_t index,
                    std::uint32_t lane) {
    if (state.rods.empty()) return;
    const Block& block = shape.blocks[index];
    const float* const roots = state.roots.data() + index * kRootRows * kBlockLanes;
    const auto row = [&](std::size_t r) { return roots[r * kBlockLanes + lane]; };
    const Quat root{row(3), row(4), row(5), row(6)};
    const RodView rod = rodViewOf(shape, rest, state, index);
    const std::size_t size = planeSize(block);
    const auto rotationAt = [&](const float* planes, std::size_t i) {
        return Quat{planes[i], planes[size + i], planes[2 * size + i], planes[3 * size + i]};
    };
    Quat inner = root;
    for (std::uint32_t p = 0; p < block.points; ++p) {
        const std::size_t i = std::size_t{p} * kBlockLanes + lane;
        for (std::size_t plane = 0; plane < kRodStatePlanes; ++plane) rod.rotation[plane * size + i] = 0.0f;
        Quat q = root;
        if (p + 1 < block.points) q = root * rotationAt(rod.restRotation, i);
        normalize(q);
        const float values[] = {q.x, q.y, q.z, q.w};
        for (std::size_t plane = 0; plane < 4; ++plane) rod.rotation[plane * size + i] = values[plane];
        if (p + 1 < block.points) {
            const Quat turn = conjugate(inner) * q;
            const float twice = turn.w < 0.0f ? -2.0f : 2.0f;
            for (const Planes& strain : {rod.strain, rod.strainBefore}) {
                strain.x[i] = twice * turn.x;
                strain.y()[i] = twice * turn.y;
                strain.z()[i] = twice * turn.z;
            }
        }
        inner = q;
    }
    rod.turn[lane] = kRodNoStep;
    rod.energy[lane] = kRodNoEnergy;
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
        {
            const Quat between = conjugate(p > 0 ? before : root) * q;
            const float twice = between.w < 0.0f ? -2.0f : 2.0f;
            for (const Planes& strain : {rod.strain, rod.strainBefore}) {
                strain.x[i] = twice * between.x;
                strain.y()[i] = twice * between.y;
                strain.z()[i] = twice * between.z;
            }
        }
        atRestBefore = atRest;
        before = q;
    }
}

void turnRodAlong(const BlockView& view, std::size_t i, Quat turn) {
    float* const x = view.rod.rotation + i;
    const std::size_t pitch = view.pitch;
    Quat q = turn * Quat{x[0], x[pitch], x[2 * pitch], x[3 * pitch]};
    normalize(q);
    x[0] = q.x;
    x[pitch] = q.y;
    x[2 * pitch] = q.z;
    x[3 * pitch] = q.w;
}

void forgetRodEnergy(const RestShape& shape, State& state) {
    if (state.rodLanes.empty()) return;
    for (std::size_t b = 0; b < shape.blocks.size(); ++b) {
        float* const energy = state.rodLanes.data() + (b * kRodLaneRows + 1) * kBlockLanes;
        std::fill_n(energy, kBlockLanes, kRodNoEnergy);
    }
}

RodView rodViewOf(const RestShape& shape, const RodRest& rest, State& state, std::size_t index) {
    RodView view;
    if (state.rods.empty()) return view;
    const Block& block = shape.blocks[index];
    const std::size_t size = planeSize(block);
    const float* const fixed = rest.planes.data() + block.firstPlane * rest.planeCount;
    float* const moving = state.rods.data() + block.firstPlane * kRodStatePlanes;
    const auto three = [&](std::size_t plane) { return Planes{moving + plane * size, size}; };
    view.tangent = {fixed, size};
    view.axis = {fixed + 3 * size, size};
    view.bend = fixed + 6 * size;
    view.mass = fixed + 7 * size;
    view.restRotation = fixed + 8 * size;
    if (rest.planeCount == kRodFlatRestPlanes) view.normal = {fixed + kRodRestPlanes * size, size};
    view.rotation = moving;
    view.increment = three(4);
    view.displacement = three(7);
    view.velocity = three(10);
    view.velocityBefore = three(13);
    view.strain = three(16);
    view.strainBefore = three(19);
    view.load = moving + 22 * size;
    view.turn = state.rodLanes.data() + index * kRodLaneRows * kBlockLanes;
    view.energy = view.turn + kBlockLanes;
    view.curved = rest.curved[index] != 0;
    return view;
}

}  // namespace hairloom::runtime
