// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/cost/step_cost.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>

#include "core/base/parallel.h"
#include "core/base/profiler.h"
#include "core/cost/thread_clock.h"
#include "runtime/engine/frame_setup.h"

namespace hairloom {
namespace {

constexpr float kFrame = 1.0f / 60.0f;
constexpr std::uint32_t kWarmUp = 20;  // frames

std::uint64_t nanosecondsNow() {
    return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(
                                          std::chrono::steady_clock::now().time_since_epoch())
                                          .count());
}

/// Of at least one value.
double medianOf(std::vector<double>& values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return *middle;
}

/// What one thread does is measured in its processor time, what several do together on the wall.
std::uint64_t workNanoseconds(bool onWall) {
    return onWall ? nanosecondsNow() : threadNanoseconds();
}

double milliseconds(std::uint64_t nanoseconds) {
    return static_cast<double>(nanoseconds) * 1e-6;
}

class TurningHead : public MovingStrands {
  public:
    TurningHead(std::uint32_t strands, std::uint32_t points, scenes::ActiveForces activeForces)
        : head_(strands, points, isStraight(activeForces)), acting_(activeForces) {}

    runtime::StrandsView view() const override { return head_.view(); }
    void move(double time, std::vector<runtime::RootFrame>& roots,
              std::vector<runtime::Sphere>& spheres) const override {
        head_.placeRoots(time, roots);
        if (hasSpheres(acting_)) spheres = head_.spheres;
    }

  private:
    scenes::HeadOfHair head_;
    scenes::ActiveForces acting_;
};

}  // namespace

std::unique_ptr<MovingStrands> turningHead(std::uint32_t strands, std::uint32_t points,
                                           scenes::ActiveForces activeForces) {
    return std::make_unique<TurningHead>(strands, points, activeForces);
}

StepRun::StepRun(std::unique_ptr<MovingStrands> strands, const runtime::SimulationSettings& settings,
                 bool allThreads, bool byStage)
    : strands_(std::move(strands)), substeps_(settings.substeps), onWall_(allThreads || byStage) {
    runtime::Host host;
    if (allThreads) host.parallelFor = parallelFor;
    if (byStage) host.nanoseconds = nanosecondsNow;
    auto made = runtime::Engine::make(strands_->view(), settings, std::move(host));
    assert(made.engine);
    engine_ = std::move(made.engine);
    strands_->move(0.0, roots_, spheres_);
    engine_->reset(roots_);
}

StepRun::StepRun(const StepScene& scene)
    : StepRun(turningHead(scene.strands, scene.points, scene.activeForces), scene.settings(),
              scene.allThreads, scene.byStage) {}

double StepRun::milliseconds(std::uint32_t frames) {
    std::vector<double> whole;
    std::array<std::vector<double>, runtime::kStageCount> stages;
    runtime::FrameInput input;
    input.dt = kFrame;
    for (std::uint32_t f = 0; f < frames; ++f) {
        time_ += static_cast<double>(kFrame);
        strands_->move(time_, roots_, spheres_);
        input.time = time_;
        input.roots_ws = roots_;
        input.spheres = spheres_;
        const std::uint64_t begin = workNanoseconds(onWall_);
        engine_->step(input);
        whole.push_back(hairloom::milliseconds(workNanoseconds(onWall_) - begin));
        for (std::size_t i = 0; i < stages.size(); ++i)
            stages[i].push_back(engine_->lastStep().stageMilliseconds[i]);
    }
    for (std::size_t i = 0; i < stages.size(); ++i) stages_[i] = medianOf(stages[i]);
    return medianOf(whole);
}

std::uint32_t StepRun::framesFor(double seconds) {
    double last = milliseconds(2);
    std::uint32_t run = 2;
    for (; run < kWarmUp && last * run < 500.0; ++run) last = milliseconds(1);
    return static_cast<std::uint32_t>(std::clamp(std::ceil(seconds * 1e3 / last), 2.0, 240.0));
}

double StepRun::work() const {
    return static_cast<double>(engine_->pointCount()) * substeps_;
}

BareSolve::BareSolve(std::uint32_t strands, std::uint32_t points, runtime::StrandModel model)
    : head_(strands, points),
      settings_(scenes::settingsFor(scenes::ActiveForces::nothing, model)),
      shape_(runtime::makeRestShape(head_.view())),
      hair_(runtime::modelOf(model).make()) {
    state_.model = model;
    state_.planes.assign(shape_->planeFloats * runtime::kStatePlanes, 0.0f);
    state_.roots.assign(shape_->blocks.size() * runtime::kRootRows * runtime::kBlockLanes, 0.0f);
    runtime::PlanInput scene;
    scene.settings = settings_;
    scene.strandCount = strands;
    scene.longestPointCount = shape_->longestPointCount;
    scene.longestStrand = shape_->longestStrand;
    scene.straight = shape_->straight;
    plan_ = runtime::plan(scene);
    hair_->takeSettings(*shape_, settings_, nullptr, state_, {});
    hair_->takeState(*shape_, settings_, state_);
    hair_->allocate(*shape_, settings_, plan_, plan_.on(runtime::Effect::collision), state_);
    const runtime::Model& kernels = runtime::modelOf(model);
    work_.resize(kernels.laneFloats + kernels.solverFloats(plan_.stages()) * points +
                 runtime::kSolverPadding);
    head_.placeRoots(0.0, roots_);
    for (std::size_t b = 0; b < shape_->blocks.size(); ++b) {
        runtime::LaneFrame lanes;
        enterFrame(b, lanes);
        for (std::uint32_t lane = 0; lane < runtime::kBlockLanes; ++lane) {
            runtime::placeAtRest(*shape_, state_, b, lane);
            hair_->placeAtRest(*shape_, state_, b, lane);
        }
    }
}

/// From where the roots were to where they are.
void BareSolve::enterFrame(std::size_t block, runtime::LaneFrame& lanes) {
    using runtime::kBlockLanes;
    float* const rows = state_.roots.data() + block * runtime::kRootRows * kBlockLanes;
    const float share = 1.0f / static_cast<float>(settings_.substeps);
    for (std::uint32_t lane = 0; lane < kBlockLanes; ++lane) {
        const runtime::RootFrame& to = roots_[shape_->blocks[block].strandOfLane[lane]];
        const float now[runtime::kRootRows] = {to.position.x, to.position.y, to.position.z, to.rotation.x,
                                               to.rotation.y, to.rotation.z, to.rotation.w};
        for (std::size_t r = 0; r < 3; ++r) {
            lanes.root[r][lane] = rows[r * kBlockLanes + lane];
            lanes.rootDisplacement[r][lane] = (now[r] - rows[r * kBlockLanes + lane]) * share;
        }
        for (std::size_t r = 0; r < 4; ++r) {
            lanes.rotationFrom[r][lane] = rows[(3 + r) * kBlockLanes + lane];
            lanes.rotationTo[r][lane] = now[3 + r];
        }
        for (std::size_t r = 0; r < runtime::kRootRows; ++r) rows[r * kBlockLanes + lane] = now[r];
    }
}

double BareSolve::milliseconds(std::uint32_t frames) {
    const runtime::Model& model = runtime::modelOf(settings_.strandModel);
    const runtime::Passes passes = model.passes(plan_.stages(), false);
    runtime::SubstepContext context =
        runtime::substepContext(settings_, plan_, kFrame, runtime::substepsIn(settings_, kFrame), {});
    context.conservative = context.spheresRest = true;
    std::vector<double> times;
    for (std::uint32_t f = 0; f < frames; ++f) {
        time_ += static_cast<double>(kFrame);
        head_.placeRoots(time_, roots_);
        const std::uint64_t begin = threadNanoseconds();
        context.stepRatio = substep_ > 0.0f ? 1.0f : runtime::kFirstStepRatio;
        substep_ = context.h;
        for (std::size_t b = 0; b < shape_->blocks.size(); ++b) {
            runtime::BlockRoom room;
            const runtime::BlockView& view = hair_->view(*shape_, state_, b, settings_.clampedPoints, room);
            runtime::LaneFrame lanes;
            lanes.own = work_.data();
            lanes.solver = work_.data() + model.laneFloats;
            enterFrame(b, lanes);
            runtime::SubstepContext substep = context;
            for (substep.index = 0; substep.index < substep.count; ++substep.index) {
                for (std::size_t i = 0; i < passes.count; ++i) passes.calls[i](view, lanes, substep);
                substep.stepRatio = 1.0f;
            }
        }
        times.push_back(hairloom::milliseconds(threadNanoseconds() - begin));
    }
    return medianOf(times);
}

double followMilliseconds(runtime::FollowHairs& hairs, const scenes::Lawn& lawn, bool allThreads,
                          std::uint32_t frames) {
    runtime::Host host;
    if (allThreads) host.parallelFor = parallelFor;
    std::vector<runtime::Float3> points(lawn.hairPointCount());
    hairs.evaluate(lawn.motion(), points, host);  // touches the memory
    std::vector<double> times;
    for (std::uint32_t f = 0; f < frames; ++f) {
        const std::uint64_t begin = workNanoseconds(allThreads);
        hairs.evaluate(lawn.motion(), points, host);
        times.push_back(milliseconds(workNanoseconds(allThreads) - begin));
    }
    return medianOf(times);
}

double profilerScopeNanoseconds(std::uint32_t batches) {
    constexpr int kScopes = 1000;
    std::vector<double> times;
    for (std::uint32_t b = 0; b < batches; ++b) {
        const std::uint64_t begin = threadNanoseconds();
        for (int i = 0; i < kScopes; ++i) {
            HAIRLOOM_PROFILE("measuring the profiler");
        }
        times.push_back(static_cast<double>(threadNanoseconds() - begin) / kScopes);
    }
    return medianOf(times);
}

}  // namespace hairloom
