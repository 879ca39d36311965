// SPDX-License-Identifier: MIT
// Springs as a model of the engine.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>

#include "models/springs/spring_kernels.h"
#include "models/springs/spring_plan.h"
#include "models/springs/springs.h"

namespace hairloom::runtime {
namespace {

/// Seconds in which the tension that bending knows of follows that of the segments.
constexpr float kTensionTime = 0.2f;

float shareLeft(float h, float timeConstant) {
    return timeConstant > 0.0f ? std::exp(-h / timeConstant) : 1.0f;
}

void fillSpringNumbers(const SimulationSettings& settings, const EffectPlan& plan, SubstepContext& context) {
    const float h = context.h;
    const auto oscillation = [&](float hertz) {
        const float turns = 2.0f * std::numbers::pi_v<float> * hertz * h;
        return turns * turns;
    };
    context.velocityShare = shareLeft(h, settings.dampingTime);
    const bool decays =
        settings.integrator == Integrator::verlet || settings.integrator == Integrator::implicitEuler;
    context.dragShare = decays ? 1.0f - std::exp(-settings.airDrag * h) : settings.airDrag * h;
    context.springStep = oscillation(settings.springFrequency);
    context.penaltyStep = oscillation(settings.penaltyFrequency);
    context.bendRate = bendRate(settings, h, plan.on(Effect::torsion));
    context.tensionShare = 1.0f - shareLeft(h, kTensionTime);
    context.lengthIterations = settings.lengthIterations;
    context.maximalExtension = settings.maximalExtension;
}

float springReach(const SimulationSettings& settings, float strandLength) {
    if (settings.lengthIterations == 0) return std::numeric_limits<float>::infinity();
    return strandLength * (1.0f + settings.maximalExtension);
}

Passes springPasses(std::span<const StageId> stages, bool timed) {
    return timed ? singlePassesOf(stages, springKernels()) : passesOf(stages, springKernels());
}

std::size_t springSolverFloats(std::span<const StageId> stages) {
    std::size_t most = 0;
    for (const StageId stage : stages)
        most = std::max(most, springKernels().solverFloats[static_cast<std::size_t>(stage)]);
    return most;
}

class SpringStrands final : public ModelStrands {
  public:
    std::unique_ptr<ModelStrands> copy() const override { return std::make_unique<SpringStrands>(*this); }

    void takeSettings(const RestShape&, const SimulationSettings&, const SimulationSettings*, State&,
                      const Host&) override {
        bend_.substep = 0.0f;
    }
    void takeState(const RestShape&, const SimulationSettings&, State& state) override {
        if (state.model == StrandModel::springs) return;
        state.model = StrandModel::springs;
        state.own = {};
    }

    void allocate(const RestShape& shape, const SimulationSettings& settings, const EffectPlan& plan, bool,
                  State& state) override {
        const bool angular = plan.on(Effect::angular);
        const bool factored = angular && plan.factored();
        const bool targets = plan.on(Effect::torsion);
        if (angular == bend_.planes.empty() || factored != bend_.factored || targets != bend_.targets) {
            bend_.factored = factored;
            bend_.targets = targets;
            bend_.planes = Floats(angular ? shape.planeFloats * bend_.planeCount() : 0, 0.0f);
            bend_.substep = 0.0f;
        }
        keepFloats(state.own[kOwnTensions], plan.keepsTensions() ? shape.planeFloats : 0);
        evaluationPlanes_ = settings.integrator == Integrator::verlet ? 0
                            : settings.integrator == Integrator::rk4  ? kRungeKuttaPlanes
                                                                      : kEvaluationPlanes;
        if (evaluation_.size() != shape.planeFloats * evaluationPlanes_)
            evaluation_ = zeroFloats(shape.planeFloats * evaluationPlanes_, {});
        bends_ = angular;
    }

    void placeAtRest(const RestShape& shape, State& state, std::size_t index,
                     LaneRange lanes) const override {
        if (state.own[kOwnTensions].empty()) return;
        const Block& block = shape.blocks[index];
        float* const tensions = state.own[kOwnTensions].data() + block.firstPlane;
        for (std::uint32_t p = 0; p < block.points; ++p) {
            float* const row = tensions + std::size_t{p} * kBlockLanes;
            std::fill(row + lanes.begin, row + lanes.end, 0.0f);
        }
    }
    void placeOnPoints(const RestShape&, State&, std::size_t, std::uint32_t) const override {}

    BlockView& view(const RestShape& shape, State& state, std::size_t index, std::uint32_t clampedPoints,
                    BlockRoom& room) override {
        auto& block = room.make<SpringBlock>();
        fillSprings({shape, state, bend_, evaluation_, evaluationPlanes_}, index, clampedPoints, block);
        return block;
    }

    void prepareBlock(const RestShape& shape, const SimulationSettings& settings, const ModelFrame& frame,
                      std::size_t index) override {
        if (isNew(frame)) fillBend(shape, settings, frame.context.h, index, bend_);
    }
    void enterBlock(const RestShape&, const SimulationSettings&, const ModelFrame& frame, std::size_t,
                    BlockView& view, LaneFrame& lanes) const override {
        const auto& block = static_cast<const SpringBlock&>(view);
        const SpringKernels& kernels = springKernels();
        springLanes(lanes).near.forget();
        if (frame.rescale != 1.0f) kernels.rescale(block, frame.rescale);
        if (!frame.windy) return;
        kernels.sampleWind(block, lanes, frame.context, frame.windFrom.data(), frame.windTo.data());
    }
    void closeFrame(const ModelFrame& frame) override {
        if (isNew(frame)) bend_.substep = frame.context.h;
    }

    std::size_t effectBytes(Effect effect, const State& state) const override {
        const std::size_t targets =
            bend_.targets ? 3 * bend_.planes.size() / bend_.planeCount() * sizeof(float) : 0;
        if (effect == Effect::torsion) return targets;
        if (effect != Effect::angular) return 0;
        return (bend_.planes.size() + state.own[kOwnTensions].size()) * sizeof(float) - targets;
    }
    std::size_t baseBytes(const State&) const override { return evaluation_.size() * sizeof(float); }

  private:
    /// Substeps of another length than the arrays are for.
    bool isNew(const ModelFrame& frame) const { return bends_ && bend_.substep != frame.context.h; }

    Bend bend_;
    Floats evaluation_;  // empty for position Verlet
    std::size_t evaluationPlanes_ = 0;
    bool bends_ = false;
};

}  // namespace

void fillSprings(const SpringArrays& arrays, std::size_t index, std::uint32_t clampedPoints,
                 SpringBlock& view) {
    const Block& block = arrays.shape.blocks[index];
    const std::size_t size = planeSize(block);
    const auto three = [&](float* first) { return Planes{first, size}; };
    fillView(arrays.shape, arrays.state, index, clampedPoints, view);
    if (!arrays.bend.planes.empty()) {
        const float* plane = arrays.bend.planes.data() + block.firstPlane * arrays.bend.planeCount();
        view.stiffness = plane;
        plane += size;
        if (arrays.bend.factored) {
            view.inverseDiagonal = plane;
            view.lower1 = plane + size;
            view.lower2 = plane + 2 * size;
            plane += 3 * size;
        }
        if (arrays.bend.targets) view.target = {plane, size};
    }
    Floats& tensions = arrays.state.own[kOwnTensions];
    if (!tensions.empty()) view.tension = tensions.data() + block.firstPlane;
    if (!arrays.evaluation.empty()) {
        float* plane = arrays.evaluation.data() + block.firstPlane * arrays.evaluationPlanes;
        view.start = three(plane);
        view.stepDisplacement = three(plane + 3 * size);
        if (arrays.evaluationPlanes == kRungeKuttaPlanes) {
            view.kick = three(plane + 6 * size);
            view.sum = three(plane + 9 * size);
            view.stepDisplacementSum = three(plane + 12 * size);
        }
    }
}

const Model& springModel() {
    static const Model kModel{
        .name = "springs",
        .effects = springEffects(),
        .listStages = listSpringStages,
        .reach = springReach,
        .fillNumbers = fillSpringNumbers,
        .passes = springPasses,
        .solverFloats = springSolverFloats,
        .make = [] { return std::unique_ptr<ModelStrands>(std::make_unique<SpringStrands>()); },
        .own = {{{.planes = 1, .isOptional = true}}},
        .laneFloats = sizeof(SpringLanes) / sizeof(float),
        .listsSpheres = false,
        .meetsBody = false,
        .keepsVelocities = false,
        // Stiffness, factors, targets and tension.
        .mostPlanes = kRungeKuttaPlanes + 8,
        .mostSolverFloats =
            [] {
                const auto& floats = springKernels().solverFloats;
                return *std::max_element(std::begin(floats), std::end(floats));
            },
        .gpuSource = "strands.hlsli",
    };
    return kModel;
}

}  // namespace hairloom::runtime
