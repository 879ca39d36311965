// SPDX-License-Identifier: MIT
#include "runtime/engine.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace hairloom::runtime {
namespace {

constexpr std::size_t kBlocksPerJob = 4;

std::string whyRefused(const SimulationSettings& settings) {
    const std::vector<FieldProblem> problems = validate(settings);
    std::string text;
    for (const FieldProblem& problem : problems) text += (text.empty() ? "" : "\n") + problem.message;
    return text;
}

std::string whyRefused(const StrandsView& strands) {
    if (strands.offsets.empty()) return "no strand offsets; expected strand count + 1 of them";
    if (strands.offsets.front() != 0 || strands.offsets.back() != strands.restPositions_ss.size()) {
        return "strand offsets run from " + std::to_string(strands.offsets.front()) + " to " +
               std::to_string(strands.offsets.back()) + "; expected 0 to the number of points, " +
               std::to_string(strands.restPositions_ss.size());
    }
    const std::size_t count = strands.offsets.size() - 1;
    if (!strands.rootRotations_ss.empty() && strands.rootRotations_ss.size() != count) {
        return std::to_string(strands.rootRotations_ss.size()) + " root rotations for " +
               std::to_string(count) + " strands; expected none or one each";
    }
    for (std::size_t s = 0; s < count; ++s) {
        if (strands.offsets[s + 1] < strands.offsets[s] + 2 ||
            strands.offsets[s + 1] > strands.offsets[s] + kMaxPoints) {
            return "strand " + std::to_string(s) + " runs from point " + std::to_string(strands.offsets[s]) +
                   " to " + std::to_string(strands.offsets[s + 1]) + "; expected 2 to " +
                   std::to_string(kMaxPoints) + " points";
        }
        Quat rotation;
        if (!strands.rootRotations_ss.empty()) rotation = strands.rootRotations_ss[s];
        if (!normalize(rotation)) return "root rotation " + std::to_string(s) + " is not a rotation";
    }
    for (std::size_t p = 0; p < strands.restPositions_ss.size(); ++p) {
        const Float3 at = strands.restPositions_ss[p];
        // Squares of what lies farther out leave the range of single precision.
        if (!isFinite(at) || std::max({std::abs(at.x), std::abs(at.y), std::abs(at.z)}) > 1e6f) {
            return "rest position of point " + std::to_string(p) + " is not a number within 1e6 m";
        }
    }
    return {};
}

/// Makes the rotation one of unit length; false where the root is no place.
bool usable(RootFrame& root) {
    return isFinite(root.position) && normalize(root.rotation);
}

/// Faster air is a mistake, and its squares would leave the range of single precision.
bool isWind(Float3 velocity) {
    constexpr float kMost = 1000.0f;  // m/s
    return isFinite(velocity) && length(velocity) <= kMost;
}

float shareLeft(float h, float timeConstant) {
    return timeConstant > 0.0f ? std::exp(-h / timeConstant) : 1.0f;
}

}  // namespace

/// What all blocks share in one step.
struct Engine::Frame {
    const FrameInput* input;
    SubstepContext context;
    std::array<float, kWindModes> windFrom, windTo;
    bool windy;
    float rescale;  ///< new substep over old, 1 when equal
    bool newBend;
};

Engine::Made Engine::make(const StrandsView& strands, const SimulationSettings& settings, Host host) {
    if (std::string error = whyRefused(settings); !error.empty()) return {std::nullopt, std::move(error)};
    if (std::string error = whyRefused(strands); !error.empty()) return {std::nullopt, std::move(error)};
    Engine engine;
    engine.host_ = std::move(host);
    engine.shape_ = makeRestShape(strands);
    const RestShape& shape = *engine.shape_;
    engine.state_.planes.assign(shape.planeFloats * kStatePlanes, 0.0f);
    engine.state_.roots.assign(shape.blocks.size() * kRootRows * kBlockLanes, 0.0f);
    if (engine.host_.nanoseconds) engine.blockNanoseconds_.resize(shape.blocks.size());
    engine.settings_ = settings;
    engine.wind_ = makeWind(settings);
    engine.reset(shape.restRoots);
    return {std::move(engine), {}};
}

void Engine::reset(std::span<const RootFrame> roots_ws) {
    assert(roots_ws.size() == strandCount());
    report_ = {};
    for (std::size_t b = 0; b < shape_->blocks.size(); ++b) {
        float* rows = state_.roots.data() + b * kRootRows * kBlockLanes;
        for (std::uint32_t lane = 0; lane < kBlockLanes; ++lane) {
            const std::uint32_t strand = shape_->blocks[b].strandOfLane[lane];
            RootFrame root = roots_ws[strand];
            if (!usable(root)) root = shape_->restRoots[strand];
            const float values[kRootRows] = {root.position.x, root.position.y, root.position.z,
                                             root.rotation.x, root.rotation.y, root.rotation.z,
                                             root.rotation.w};
            for (std::size_t r = 0; r < kRootRows; ++r) rows[r * kBlockLanes + lane] = values[r];
        }
        placeAtRest(*shape_, state_, b);
    }
    state_.spheres.clear();
    state_.bend.clear();
    state_.substep = 0.0f;
    FrameInput here;
    here.roots_ws = roots_ws;
    takeRootBounds(here);
    replan({}, {}, state_.rootsMin_ws, state_.rootsMax_ws);
}

std::string Engine::setSettings(const SimulationSettings& settings) {
    if (std::string error = whyRefused(settings); !error.empty()) return error;
    settings_ = settings;
    wind_ = makeWind(settings);
    windGiven_ = false;
    state_.bendSubstep = 0.0f;
    replan({}, {}, state_.rootsMin_ws, state_.rootsMax_ws);
    return {};
}

void Engine::replan(std::span<const Sphere> spheres, std::span<const Float3> sphereMotion, Float3 rootsMin_ws,
                    Float3 rootsMax_ws) {
    SimulationSettings planned = settings_;
    if (windGiven_) {
        planned.windSpeed = length(wind_.mean);
        if (planned.windSpeed > 0.0f) planned.windDirection = wind_.mean * (1.0f / planned.windSpeed);
    }
    plan_ = runtime::plan({planned, strandCount(), shape_->longestPointCount, shape_->longestStrand,
                           rootsMin_ws, rootsMax_ws, spheres, sphereMotion});
    allocateForPlan();
}

void Engine::allocateForPlan() {
    if (plan_.on(Effect::angular) == !state_.bend.empty()) return;
    state_.bend = Floats(plan_.on(Effect::angular) ? shape_->planeFloats * kBendPlanes : 0, 0.0f);
    state_.bendSubstep = 0.0f;
}

void Engine::takeRootBounds(const FrameInput& input) {
    Float3 low{1e30f, 1e30f, 1e30f}, high{-1e30f, -1e30f, -1e30f};
    for (const RootFrame& root : input.roots_ws) {
        const Float3 p = root.position;
        if (!isFinite(p)) continue;
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    state_.rootsMin_ws = low;
    state_.rootsMax_ws = high;
}

void Engine::takeSpheres(const FrameInput& input) {
    usableSpheres_.assign(input.spheres.begin(), input.spheres.end());
    sphereMotion_.assign(usableSpheres_.size(), Float3{});
    for (std::size_t i = 0; i < usableSpheres_.size(); ++i) {
        Sphere& sphere = usableSpheres_[i];
        if (!isFinite(sphere.center_ws) || !std::isfinite(sphere.radius) || !(sphere.radius > 0.0f)) {
            sphere = {};
            ++report_.rejectedSpheres;
            continue;
        }
        if (i < state_.spheres.size() && state_.spheres[i].radius > 0.0f) {
            const Float3 motion = sphere.center_ws - state_.spheres[i].center_ws;
            if (length(motion) <= settings_.teleportDistance) sphereMotion_[i] = motion;
        }
    }
}

void Engine::takeWind(const FrameInput& input) {
    WindInput given;
    if (input.wind_ws) {
        if (isWind(*input.wind_ws)) {
            given.mean_ws = input.wind_ws;
        } else {
            ++report_.rejectedWinds;
        }
    }
    if (isWind(input.actorVelocity_ws)) {
        given.actorVelocity_ws = input.actorVelocity_ws;
    } else {
        ++report_.rejectedWinds;
    }
    windGiven_ =
        given.mean_ws || (settings_.windKind == WindKind::vehicle && given.actorVelocity_ws != Float3{});
    wind_ = makeWind(settings_, given);
}

void Engine::moveSpheres() {
    if (!plan_.on(Effect::collision)) {
        movingSpheres_ = {};
        return;
    }
    movingSpheres_.clear();
    const float share = 1.0f / static_cast<float>(settings_.substeps);
    for (std::size_t i = 0; i < usableSpheres_.size(); ++i) {
        const Sphere& sphere = usableSpheres_[i];
        if (!(sphere.radius > 0.0f)) continue;
        movingSpheres_.push_back(
            {sphere.center_ws - sphereMotion_[i], sphereMotion_[i] * share, sphere.radius});
    }
}

void Engine::step(const FrameInput& input) {
    assert(input.roots_ws.size() == strandCount());
    if (!(input.dt > 0.0f) || !std::isfinite(input.dt)) return;
    const std::uint64_t begin = host_.nanoseconds ? host_.nanoseconds() : 0;
    report_ = {};
    const float h = input.dt / static_cast<float>(settings_.substeps);

    const Float3 lowBefore = state_.rootsMin_ws, highBefore = state_.rootsMax_ws;
    takeRootBounds(input);
    const Float3 low = state_.rootsMin_ws, high = state_.rootsMax_ws;
    takeSpheres(input);
    takeWind(input);
    replan(usableSpheres_, sphereMotion_,
           {std::min(low.x, lowBefore.x), std::min(low.y, lowBefore.y), std::min(low.z, lowBefore.z)},
           {std::max(high.x, highBefore.x), std::max(high.y, highBefore.y), std::max(high.z, highBefore.z)});

    moveSpheres();

    Frame frame{};
    frame.input = &input;
    frame.context.count = settings_.substeps;
    frame.context.h = h;
    frame.context.velocityShare = shareLeft(h, settings_.dampingTime);
    frame.context.gravityStep = settings_.gravity * (h * h);
    frame.context.dragShare = 1.0f - std::exp(-settings_.airDrag * h);
    frame.context.lengthIterations = settings_.lengthIterations;
    frame.context.maximalExtension = settings_.maximalExtension;
    frame.context.pearlRoot = settings_.pearlRadiusRoot;
    frame.context.pearlTip = settings_.pearlRadiusTip;
    frame.context.friction = settings_.friction;
    frame.context.restitution = settings_.restitution;
    const float penalty = 2.0f * std::numbers::pi_v<float> * settings_.penaltyFrequency * h;
    frame.context.penaltyStep = penalty * penalty;
    frame.context.spheres = movingSpheres_;
    frame.windy = plan_.on(Effect::wind);
    if (frame.windy) {
        const double time = std::isfinite(input.time) ? input.time : 0.0;
        frame.windFrom = windPhases(wind_, time - static_cast<double>(input.dt));
        frame.windTo = windPhases(wind_, time);
    }
    frame.rescale = state_.substep > 0.0f ? h / state_.substep : 1.0f;
    frame.newBend = plan_.on(Effect::angular) && state_.bendSubstep != h;

    const std::size_t blocks = shape_->blocks.size();
    const Host::Body body = [&](std::size_t first, std::size_t end) {
        for (std::size_t b = first; b < end; ++b) runBlock(b, frame);
    };
    if (host_.parallelFor) {
        host_.parallelFor(blocks, kBlocksPerJob, body);
    } else {
        body(0, blocks);
    }
    for (RootFrame root : input.roots_ws) report_.rejectedRoots += usable(root) ? 0 : 1;

    state_.spheres.assign(usableSpheres_.begin(), usableSpheres_.end());
    state_.substep = h;
    if (frame.newBend) state_.bendSubstep = h;
    if (host_.nanoseconds) {
        report_.milliseconds = static_cast<double>(host_.nanoseconds() - begin) * 1e-6;
        sumTimes();
    }
}

void Engine::sumTimes() {
    for (const auto& times : blockNanoseconds_) {
        for (std::size_t i = 0; i < kStageCount; ++i) {
            report_.stageMilliseconds[i] += static_cast<double>(times[i]) * 1e-6;
        }
    }
}

void Engine::runBlock(std::size_t block, const Frame& frame) {
    const BlockView view = viewOf(*shape_, state_, block, settings_.clampedPoints);
    LaneFrame lanes;
    enterFrame(block, view, lanes, frame);
    if (frame.rescale != 1.0f) kernels().rescale(view, frame.rescale);
    if (frame.newBend) {
        fillBend(*shape_, settings_, frame.context.h, block, state_);
    }
    if (frame.windy) {
        kernels().sampleWind(view, lanes, frame.context.h, wind_, frame.windFrom.data(), frame.windTo.data());
    }
    runStages(block, view, lanes, frame);
}

/// Fills the lanes' way through the frame and keeps its end for the next. A cut turns the strand along
/// rigidly.
void Engine::enterFrame(std::size_t block, const BlockView& view, LaneFrame& lanes, const Frame& frame) {
    float* rows = state_.roots.data() + block * kRootRows * kBlockLanes;
    const float share = 1.0f / static_cast<float>(frame.context.count);
    for (std::uint32_t lane = 0; lane < kBlockLanes; ++lane) {
        const auto row = [&](std::size_t r) -> float& { return rows[r * kBlockLanes + lane]; };
        RootFrame from{{row(0), row(1), row(2)}, {row(3), row(4), row(5), row(6)}};
        RootFrame to = frame.input->roots_ws[shape_->blocks[block].strandOfLane[lane]];
        if (!usable(to)) to = from;
        if (!(length(to.position - from.position) <= settings_.teleportDistance)) {
            const Quat turn = to.rotation * conjugate(from.rotation);
            for (std::uint32_t p = 0; p < view.points; ++p) {
                const std::size_t i = std::size_t{p} * kBlockLanes + lane;
                for (const Planes& planes : {view.position, view.previous}) {
                    const Float3 turned = rotate(turn, Float3{planes.x[i], planes.y[i], planes.z[i]});
                    planes.x[i] = turned.x;
                    planes.y[i] = turned.y;
                    planes.z[i] = turned.z;
                }
            }
            from = to;
        }
        const Float3 step = (to.position - from.position) * share;
        const float starts[] = {from.position.x, from.position.y, from.position.z};
        const float steps[] = {step.x, step.y, step.z};
        for (std::size_t r = 0; r < 3; ++r) {
            lanes.root[r][lane] = starts[r];
            lanes.rootStep[r][lane] = steps[r];
        }
        const Quat rotations[] = {from.rotation, to.rotation};
        float(*targets[])[kBlockLanes] = {lanes.rotationFrom, lanes.rotationTo};
        for (std::size_t k = 0; k < 2; ++k) {
            targets[k][0][lane] = rotations[k].x;
            targets[k][1][lane] = rotations[k].y;
            targets[k][2][lane] = rotations[k].z;
            targets[k][3][lane] = rotations[k].w;
        }
        row(0) = to.position.x, row(1) = to.position.y, row(2) = to.position.z;
        row(3) = to.rotation.x, row(4) = to.rotation.y, row(5) = to.rotation.z, row(6) = to.rotation.w;
    }
}

void Engine::runStages(std::size_t block, const BlockView& view, LaneFrame& lanes, const Frame& frame) {
    const Kernels& table = kernels();
    SubstepContext context = frame.context;
    if (blockNanoseconds_.empty()) {
        for (context.index = 0; context.index < context.count; ++context.index) {
            for (const StageId id : plan_.stages())
                table.stages[static_cast<std::size_t>(id)](view, lanes, context);
        }
        return;
    }
    auto& times = blockNanoseconds_[block];
    times.fill(0);
    std::uint64_t before = host_.nanoseconds();
    for (context.index = 0; context.index < context.count; ++context.index) {
        for (const StageId id : plan_.stages()) {
            table.stages[static_cast<std::size_t>(id)](view, lanes, context);
            const std::uint64_t after = host_.nanoseconds();
            times[static_cast<std::size_t>(id)] += after - before;
            before = after;
        }
    }
}

const char* Engine::instructionSet() {
    return kernels().target;
}

}  // namespace hairloom::runtime
