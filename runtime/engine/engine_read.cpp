// SPDX-License-Identifier: MIT
// What a state looks like from outside, and what an engine takes of memory.
#include <algorithm>
#include <cmath>

#include "engine/engine_impl.h"
#include "hairloom/capsules.h"

namespace hairloom::runtime {
namespace {

struct ConstBlock {
    const Block* block;
    const float* moving;
    const float* rest;
    const float* roots;
    std::size_t size;

    Float3 position(std::size_t i) const { return {moving[i], moving[size + i], moving[2 * size + i]}; }
    Float3 displacement(std::size_t i) const {
        return position(i) - Float3{moving[3 * size + i], moving[4 * size + i], moving[5 * size + i]};
    }
    float restLength(std::size_t i) const { return rest[3 * size + i]; }
    double mass(std::size_t i) const { return 1.0 / static_cast<double>(rest[5 * size + i]); }
    Float3 root(std::size_t lane) const {
        return {roots[lane], roots[kBlockLanes + lane], roots[2 * kBlockLanes + lane]};
    }
};

ConstBlock constBlock(const RestShape& shape, const State& state, std::size_t b) {
    const Block& block = shape.blocks[b];
    return {&block, state.planes.data() + block.firstPlane * kStatePlanes,
            shape.planes.data() + block.firstPlane * kRestPlanes,
            state.roots.data() + b * kRootRows * kBlockLanes, planeSize(block)};
}

/// Calls visit(block, lane, point, index into planes, index of the point in the caller's order) for each
/// point.
template <class Visit>
void forEachPoint(const RestShape& shape, const State& state, Visit&& visit) {
    for (std::size_t b = 0; b < shape.blocks.size(); ++b) {
        const ConstBlock view = constBlock(shape, state, b);
        for (std::uint32_t lane = 0; lane < view.block->strands; ++lane) {
            const std::size_t first = shape.offsets[view.block->strandOfLane[lane]];
            for (std::uint32_t p = 0; p < view.block->points; ++p) {
                visit(view, lane, p, std::size_t{p} * kBlockLanes + lane, first + p);
            }
        }
    }
}

double lengthOf(Float3 v) {
    return std::sqrt(static_cast<double>(v.x) * v.x + static_cast<double>(v.y) * v.y +
                     static_cast<double>(v.z) * v.z);
}

}  // namespace

void readPositions(const RestShape& shape, const State& state, std::span<Float3> positions_ws) {
    forEachPoint(shape, state,
                 [&](const ConstBlock& view, std::uint32_t lane, std::uint32_t, std::size_t i,
                     std::size_t at) { positions_ws[at] = view.root(lane) + view.position(i); });
}

void readVelocities(const RestShape& shape, const State& state, std::span<Float3> velocities_ws) {
    const float rate = state.substep > 0.0f ? 1.0f / state.substep : 0.0f;
    forEachPoint(shape, state,
                 [&](const ConstBlock& view, std::uint32_t, std::uint32_t, std::size_t i, std::size_t at) {
                     velocities_ws[at] = view.displacement(i) * rate;
                 });
}

Measurements measureState(const RestShape& shape, const State& state, const SimulationSettings& settings,
                          std::span<const std::uint8_t> skinSpheres) {
    Measurements result;
    const double rate = state.substep > 0.0f ? 1.0 / static_cast<double>(state.substep) : 0.0;
    const SimulationSettings& s = settings;
    for (std::size_t b = 0; b < state.rests.size(); ++b) {
        if (state.rests[b].asleep) result.asleep += shape.blocks[b].strands;
    }
    forEachPoint(
        shape, state,
        [&](const ConstBlock& view, std::uint32_t lane, std::uint32_t p, std::size_t i, std::size_t) {
            const Float3 at = view.position(i);
            const Float3 moved = view.displacement(i);
            if (!isFinite(at) || !isFinite(moved)) {
                ++result.nanCount;
                return;
            }
            if (p > 0 && view.restLength(i - kBlockLanes) > 1e-9f) {
                const double ratio = lengthOf(at - view.position(i - kBlockLanes)) /
                                     static_cast<double>(view.restLength(i - kBlockLanes));
                result.maxStretch = std::max(result.maxStretch, std::abs(ratio - 1.0));
            }
            if (p < s.clampedPoints) return;
            const Float3 at_ws = view.root(lane) + at;
            const double speed = lengthOf(moved) * rate;
            result.fastest = std::max(result.fastest, speed);
            result.kineticEnergy += 0.5 * view.mass(i) * speed * speed;
            result.potentialEnergy -= view.mass(i) * static_cast<double>(dot(s.gravity, at_ws));
            const double along = static_cast<double>(p) / (view.block->points - 1);
            const double collisionRadius =
                static_cast<double>(s.collisionRadiusRoot) +
                along * static_cast<double>(s.collisionRadiusTip - s.collisionRadiusRoot);
            const auto meet = [&](const Sphere& sphere) {
                if (!(sphere.radius > 0.0f)) return;
                const double depth =
                    static_cast<double>(sphere.radius) + collisionRadius - lengthOf(at_ws - sphere.center_ws);
                result.maxPenetration = std::max(result.maxPenetration, depth);
            };
            const auto isOfSkin = [&](std::size_t k) {
                return k < skinSpheres.size() && skinSpheres[k] != 0;
            };
            for (std::size_t k = 0; k < state.spheres.size(); ++k) {
                if (!isOfSkin(k)) meet(state.spheres[k]);
            }
            for (const Capsule& capsule : state.capsules) {
                if (isOfSkin(capsule.first) && isOfSkin(capsule.second)) continue;
                if (isCapsule(capsule, state.spheres))
                    meet(
                        nearestOfCapsule(state.spheres[capsule.first], state.spheres[capsule.second], at_ws));
            }
        });
    return result;
}

std::uint32_t Engine::asleep() const {
    std::uint32_t strands = 0;
    for (std::size_t b = 0; b < impl_->state_.rests.size(); ++b)
        strands += impl_->state_.rests[b].asleep ? impl_->shape_->blocks[b].strands : 0;
    return strands;
}

std::size_t Engine::Impl::effectBytes(Effect effect) const {
    // Forces that contacts leave are of the body where there are no spheres in reach.
    if (effect == Effect::collision && meetsBody() && !plan_.on(effect)) return 0;
    std::size_t shared = 0;
    if (effect == Effect::wind && plan_.on(effect)) shared = sizeof(Wind);
    if (effect == Effect::collision && plan_.on(effect))
        shared =
            movingSpheres_.size() * sizeof(MovingSphere) + movingCapsules_.size() * sizeof(MovingCapsule);
    if (effect == Effect::hairHair) shared = hairGrid_.bytes();
    return shared + strands_->effectBytes(effect, state_);
}

std::size_t Engine::Impl::baseBytes() const {
    return shape_->bytes() + (state_.planes.size() + state_.roots.size()) * sizeof(float) +
           strands_->baseBytes(state_) +
           (state_.spheres.size() + spheres_.usable.size() + spheres_.planned.size()) * sizeof(Sphere) +
           (spheres_.motion.size() + spheres_.plannedMotion.size()) * sizeof(Float3) +
           (state_.capsules.size() + spheres_.capsules.size()) * sizeof(Capsule) + spheres_.ends.size() +
           spheres_.ofSkin.size() + skinSpheres_.size() + state_.rests.size() * sizeof(Rest) +
           (nextRoots_.size() + clearances_.size() + bodySeen_.size()) * sizeof(float) + bodyTable_.bytes() +
           blockReports_.size() * sizeof(BlockReport) + scratch_.bytes() + pieces_.bytes() +
           rootsNow_.size() * sizeof(RootFrame);
}

}  // namespace hairloom::runtime
