// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A few substeps of any plan from any state, by the stages of the engine on the CPU: what the kernels on the
// device are held against.

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "core/gpu_simulation/strand_engine.h"
#include "runtime/engine/scratch.h"
#include "runtime/models/rods/rods.h"
#include "runtime/models/springs/springs.h"
#include "tests/support/spring_settings.h"

namespace hairloom::gpu_simulation::test {

using runtime::Float3;
using runtime::Quat;

inline constexpr float kStep = 1.0f / 480.0f;

/// Strands, a state of theirs, and the frame that goes on from it.
struct Scene {
    runtime::SimulationSettings settings = runtime::springSettings();  ///< whose substeps are kStep long
    std::uint32_t substeps = 0;                                        ///< of the frame
    std::vector<std::uint32_t> offsets{0};
    std::vector<Float3> positions;
    runtime::Vector<runtime::RootFrame> roots;  ///< at the end of the frame
    runtime::Vector<runtime::Sphere> spheres;   ///< likewise
    runtime::State state;                       ///< before it
    std::shared_ptr<const runtime::RestShape> shape;

    runtime::StrandsView view() const { return {offsets, positions}; }
    runtime::FrameInput input() const {
        runtime::FrameInput input;
        input.dt = kStep * static_cast<float>(substeps);
        input.time = 0.7;
        input.roots_ws = roots;
        input.spheres = spheres;
        return input;
    }
};

/// What strands are like.
enum class Hair { straight, curled, nasty };

/// Reproducible numbers.
class Dice {
  public:
    explicit Dice(std::uint32_t seed) : engine_(seed) {}
    float between(float low, float high) {
        return low + (high - low) * static_cast<float>(engine_() & 0xffffffu) / static_cast<float>(0x1000000);
    }
    Float3 inside(float radius) {
        return {between(-radius, radius), between(-radius, radius), between(-radius, radius)};
    }
    Quat turn(float maximum) {
        Quat q{between(-maximum, maximum), between(-maximum, maximum), between(-maximum, maximum), 1.0f};
        runtime::normalize(q);
        return q;
    }

  private:
    std::minstd_rand engine_;
};

/// Strands of about 0.2 m around the origin. Nasty ones have segments without length, of 1 µm and of 1 m.
inline void addStrands(Scene& scene, Hair hair, std::uint32_t count, std::span<const std::uint32_t> points,
                       Dice& dice) {
    for (std::uint32_t s = 0; s < count; ++s) {
        Float3 at = dice.inside(0.1f);
        Float3 direction = dice.inside(1.0f) + Float3{0.0f, -1.5f, 0.0f};
        const std::uint32_t pointCount = points[s % points.size()];
        for (std::uint32_t p = 0; p < pointCount; ++p) {
            scene.positions.push_back(at);
            if (hair != Hair::straight) direction = direction + dice.inside(0.8f);
            float segment = 0.2f / static_cast<float>(pointCount);
            if (hair == Hair::nasty && p > 0 && p % 5 == 3) {
                constexpr float kOdd[] = {0.0f, 1e-6f, 1.0f};
                segment = kOdd[(s + p) % 3];
            }
            at = at + direction * (segment / length(direction));
        }
        scene.offsets.push_back(static_cast<std::uint32_t>(scene.positions.size()));
    }
}

/// Where a strand stands among the blocks.
struct Seat {
    std::size_t block = 0;
    std::uint32_t lane = 0;
};
/// Of each strand: random numbers are drawn in the order of the strands, so that a state does not depend on
/// how they are dealt to blocks.
inline std::vector<Seat> seatsOf(const runtime::RestShape& shape) {
    std::vector<Seat> seats(shape.restRoots.size());
    for (std::size_t b = 0; b < shape.blocks.size(); ++b) {
        const runtime::Block& block = shape.blocks[b];
        for (std::uint32_t lane = 0; lane < block.strands; ++lane)
            seats[block.strandOfLane[lane]] = {b, lane};
    }
    return seats;
}

/// Lanes without a strand are like the block's last strand.
inline void fillSpareLanes(const runtime::RestShape& shape, runtime::State& state) {
    for (const runtime::Block& block : shape.blocks) {
        float* const planes = state.planes.data() + block.firstPlane * runtime::kStatePlanes;
        for (std::size_t plane = 0; plane < runtime::kStatePlanes; ++plane) {
            for (std::uint32_t p = 0; p < block.points; ++p) {
                float* const lanes =
                    planes + plane * planeSize(block) + std::size_t{p} * runtime::kBlockLanes;
                std::fill(lanes + block.strands, lanes + runtime::kBlockLanes, lanes[block.strands - 1]);
            }
        }
    }
}

/// Moves every point of the state off its rest position and gives it a speed. Nasty states have points in one
/// position, folds by 180° and a point that flies at 500 m/s.
/// Others are off by up to `most` metres along each axis, and move in proportion, at 3 m/s for 2 mm.
inline void disturb(Scene& scene, Hair hair, Dice& dice, float maximum = 0.002f) {
    const std::vector<Seat> seats = seatsOf(*scene.shape);
    for (std::uint32_t strand = 0; strand < seats.size(); ++strand) {
        const runtime::Block& block = scene.shape->blocks[seats[strand].block];
        const std::size_t size = planeSize(block);
        float* const planes = scene.state.planes.data() + block.firstPlane * runtime::kStatePlanes;
        for (std::uint32_t p = scene.settings.clampedPoints; p < block.points; ++p) {
            const std::size_t i = std::size_t{p} * runtime::kBlockLanes + seats[strand].lane;
            const std::size_t before = i - runtime::kBlockLanes;
            const Float3 shift = dice.inside(hair == Hair::nasty ? 0.01f : maximum);
            const Float3 moved = dice.inside(3.0f * kStep * maximum / 0.002f);
            const bool odd = hair == Hair::nasty && p > 2;
            for (std::size_t k = 0; k < 3; ++k) {
                float& position = planes[k * size + i];
                position += k == 0 ? shift.x : k == 1 ? shift.y : shift.z;
                if (odd && (p + strand) % 7 == 0) position = planes[k * size + before];
                if (odd && (p + strand) % 7 == 3) position = planes[k * size + before - runtime::kBlockLanes];
                const float way = k == 0 ? moved.x : k == 1 ? moved.y : moved.z;
                planes[(3 + k) * size + i] =
                    position - (odd && (p + strand) % 11 == 0 ? 500.0f * kStep : way);
            }
        }
    }
    fillSpareLanes(*scene.shape, scene.state);
}

/// Where the settings say so, strands are rods that pass through the state's points.
inline void makeRods(Scene& scene) {
    scene.state.model = scene.settings.strandModel;
    if (scene.settings.strandModel != runtime::StrandModel::rods) return;
    const runtime::RestShape& shape = *scene.shape;
    const runtime::RodRest rest = runtime::makeRodRest(shape, scene.settings);
    runtime::allocateRods(shape, rest.parts, {.loads = true}, scene.state);
    for (std::size_t b = 0; b < shape.blocks.size(); ++b) {
        for (std::uint32_t lane = 0; lane < runtime::kBlockLanes; ++lane)
            runtime::placeRodOnPoints(shape, rest, scene.state, b, lane);
    }
}

/// A scene of 64 strands whose roots move and turn, about three spheres of which one moves.
inline Scene makeScene(const runtime::SimulationSettings& settings, Hair hair, std::uint32_t seed,
                       std::span<const std::uint32_t> points, float maximum = 0.002f) {
    Scene scene;
    scene.settings = settings;
    scene.substeps = settings.substeps;
    scene.settings.substeps = static_cast<std::uint32_t>(std::lround(runtime::kUsualFrame / kStep));
    Dice dice(seed);
    addStrands(scene, hair, 64, points, dice);
    scene.shape = runtime::makeRestShape(scene.view());
    const runtime::RestShape& shape = *scene.shape;
    runtime::State& state = scene.state;
    state.planes.assign(shape.planeFloats * runtime::kStatePlanes, 0.0f);
    state.roots.assign(shape.blocks.size() * runtime::kRootRows * runtime::kBlockLanes, 0.0f);
    state.rests.resize(shape.blocks.size());
    state.substep = kStep;
    for (const runtime::RootFrame& root : shape.restRoots)
        scene.roots.push_back({root.position + dice.inside(0.002f), dice.turn(0.02f)});
    for (std::size_t b = 0; b < shape.blocks.size(); ++b) {
        for (std::uint32_t lane = 0; lane < runtime::kBlockLanes; ++lane) {
            const Float3 position = shape.restRoots[shape.blocks[b].strandOfLane[lane]].position;
            const float rows[] = {position.x, position.y, position.z, 0.0f, 0.0f, 0.0f, 1.0f};
            for (std::size_t r = 0; r < runtime::kRootRows; ++r)
                state.roots[(b * runtime::kRootRows + r) * runtime::kBlockLanes + lane] = rows[r];
            runtime::placeAtRest(shape, state, b, lane);
        }
    }
    disturb(scene, hair, dice, maximum);
    makeRods(scene);
    scene.spheres = {
        {{0.0f, -0.05f, 0.0f}, 0.06f}, {{0.05f, -0.1f, 0.02f}, 0.05f}, {{-0.1f, 0.0f, 0.0f}, 0.03f}};
    state.spheres = scene.spheres;
    state.spheres[2].center_ws.x -= 0.01f;
    return scene;
}

/// The plan of the device's engine for this scene.
struct CpuFrame {
    runtime::FrameSpheres spheres;
    runtime::FrameWind wind;
    runtime::EffectPlan plan;
    runtime::SubstepContext context;
    runtime::Vector<runtime::MovingSphere> moving;

    explicit CpuFrame(const Scene& scene) {
        const runtime::RestShape& shape = *scene.shape;
        const float dt = scene.input().dt;
        runtime::takeSpheres(scene.settings, shape.longestStrand, {scene.state.spheres, scene.state.capsules},
                             scene.spheres, {}, spheres);
        wind.wind = runtime::makeWind(scene.settings);
        runtime::FramePlanInput planInput;
        planInput.strandCount = 64;
        planInput.longestPointCount = shape.longestPointCount;
        planInput.longestStrand = shape.longestStrand;
        planInput.straight = shape.straight;
        planInput.rootsMin_ws = {-1.0f, -1.0f, -1.0f};
        planInput.rootsMax_ws = {1.0f, 1.0f, 1.0f};
        planInput.fastest = std::numeric_limits<float>::infinity();
        plan =
            runtime::planFrame(scene.settings, planInput, wind, spheres.planned, spheres.plannedMotion, dt);
        if (plan.on(runtime::Effect::collision)) runtime::moveSpheres(spheres, scene.substeps, moving);
        context = runtime::substepContext(scene.settings, plan, dt, scene.substeps, moving);
    }
};

inline void fillLanes(const Scene& scene, std::size_t b, runtime::LaneFrame& lanes) {
    const float* rows = scene.state.roots.data() + b * runtime::kRootRows * runtime::kBlockLanes;
    for (std::uint32_t lane = 0; lane < runtime::kBlockLanes; ++lane) {
        const runtime::RootFrame& to = scene.roots[scene.shape->blocks[b].strandOfLane[lane]];
        const float ends[] = {to.position.x, to.position.y, to.position.z};
        const float turns[] = {to.rotation.x, to.rotation.y, to.rotation.z, to.rotation.w};
        for (std::size_t k = 0; k < 3; ++k) {
            lanes.root[k][lane] = rows[k * runtime::kBlockLanes + lane];
            lanes.rootDisplacement[k][lane] =
                (ends[k] - lanes.root[k][lane]) * (1.0f / static_cast<float>(scene.substeps));
        }
        for (std::size_t k = 0; k < 4; ++k) {
            lanes.rotationFrom[k][lane] = rows[(3 + k) * runtime::kBlockLanes + lane];
            lanes.rotationTo[k][lane] = turns[k];
        }
    }
}

/// What the engine does not put back to rest.
inline bool isSound(const runtime::BlockView& view, std::uint32_t lane) {
    for (std::uint32_t p = 0; p < view.points; ++p) {
        const std::size_t i = std::size_t{p} * runtime::kBlockLanes + lane;
        const Float3 position{view.position.x[i], view.position.y()[i], view.position.z()[i]};
        const Float3 before{view.previous.x[i], view.previous.y()[i], view.previous.z()[i]};
        const Float3 moved = position - before;
        if (!(dot(position, position) < 1e12f) || !(dot(moved, moved) < 1e12f)) return false;
    }
    return true;
}

/// The state after the frame, by the stages of the CPU.
inline runtime::State runOnCpu(const Scene& scene) {
    runtime::State state = scene.state;
    const runtime::RestShape& shape = *scene.shape;
    const CpuFrame frame(scene);
    const runtime::Model& model = runtime::modelOf(scene.settings.strandModel);
    const bool rods = scene.settings.strandModel == runtime::StrandModel::rods;
    const runtime::OwnedStrands strands(model.make());
    strands->takeSettings(shape, scene.settings, nullptr, state, {});
    strands->takeState(shape, scene.settings, state);
    strands->allocate(shape, scene.settings, frame.plan, false, state);
    runtime::ModelFrame modelFrame;
    modelFrame.context = frame.context;
    modelFrame.context.wind = &frame.wind.wind;
    modelFrame.windy = frame.plan.on(runtime::Effect::wind);
    modelFrame.windFrom = runtime::windPhases(frame.wind.wind, 0.7 - static_cast<double>(scene.input().dt));
    modelFrame.windTo = runtime::windPhases(frame.wind.wind, 0.7);
    for (std::size_t b = 0; b < shape.blocks.size(); ++b) {
        strands->prepareBlock(shape, scene.settings, modelFrame, b);
        runtime::BlockRoom room;
        runtime::BlockView& view = strands->view(shape, state, b, scene.settings.clampedPoints, room);
        const auto lanesOfBlock = std::make_unique<runtime::LaneFrame>();
        runtime::LaneFrame& lanes = *lanesOfBlock;
        runtime::Floats work(model.laneFloats + model.solverFloats(frame.plan.stages()) * view.points +
                             runtime::kSolverPadding);
        lanes.own = work.data();
        lanes.solver = work.data() + model.laneFloats;
        fillLanes(scene, b, lanes);
        strands->enterBlock(shape, scene.settings, modelFrame, b, view, lanes);
        // All, as kernels of a device look at them.
        if (rods) lanes.touchable = frame.moving;
        runtime::SubstepContext context = frame.context;
        context.conservative = !frame.plan.on(runtime::Effect::wind);
        context.wind = &frame.wind.wind;
        const runtime::Passes passes = model.passes(frame.plan.stages(), false);
        for (context.index = 0; context.index < context.count; ++context.index) {
            const auto left = static_cast<double>(context.count - 1 - context.index);
            const auto phases =
                runtime::windPhases(frame.wind.wind, 0.7 - left * static_cast<double>(context.h));
            context.windPhases = phases.data();
            for (std::size_t i = 0; i < passes.count; ++i) passes.calls[i](view, lanes, context);
        }
        for (std::uint32_t lane = 0; lane < runtime::kBlockLanes; ++lane) {
            for (std::size_t k = 0; k < 3; ++k) {
                float* const rows = state.roots.data() + b * runtime::kRootRows * runtime::kBlockLanes + lane;
                rows[k * runtime::kBlockLanes] +=
                    lanes.rootDisplacement[k][lane] * static_cast<float>(context.count);
            }
            for (std::size_t k = 0; k < 4; ++k)
                state.roots[(b * runtime::kRootRows + 3 + k) * runtime::kBlockLanes + lane] =
                    lanes.rotationTo[k][lane];
            if (isSound(view, lane)) continue;
            runtime::placeAtRest(shape, state, b, lane);
            strands->placeAtRest(shape, state, b, lane);
        }
    }
    return state;
}

/// How far two states are from each other.
struct Distance {
    /// Of each strand the greatest of a position or a displacement, metres; where they are greater than a
    /// metre, the share of it.
    std::vector<double> strands;
    std::size_t lost = 0;  ///< points that are a number in one state only
};
inline Distance distanceOf(const Scene& scene, const runtime::State& a, const runtime::State& b) {
    Distance distance;
    distance.strands.resize(scene.offsets.size() - 1);
    for (const runtime::Block& block : scene.shape->blocks) {
        const std::size_t size = planeSize(block);
        const auto at = [&](const runtime::State& state, std::size_t plane, std::size_t i) {
            const float* p =
                state.planes.data() + block.firstPlane * runtime::kStatePlanes + plane * size + i;
            return Float3{p[0], p[size], p[2 * size]};
        };
        for (std::uint32_t lane = 0; lane < block.strands; ++lane) {
            double greatest = 0.0;
            float maximum = 1.0f;
            for (std::uint32_t p = 0; p < block.points; ++p) {
                const std::size_t i = std::size_t{p} * runtime::kBlockLanes + lane;
                const Float3 position = at(a, 0, i), other = at(b, 0, i);
                const Float3 moved = position - at(a, 3, i), otherMoved = other - at(b, 3, i);
                if (isFinite(position) != isFinite(other)) ++distance.lost;
                greatest = std::max({greatest, static_cast<double>(length(position - other)),
                                     static_cast<double>(length(moved - otherMoved))});
                maximum = std::max({maximum, length(other), length(otherMoved)});
            }
            distance.strands[block.strandOfLane[lane]] = greatest / static_cast<double>(maximum);
        }
    }
    return distance;
}

}  // namespace hairloom::gpu_simulation::test
