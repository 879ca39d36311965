// SPDX-License-Identifier: MIT
// Rods as a model of the engine: their effects, arrays and numbers. All that moves a rod is one solve, so an
// effect is a part of it: its arrays are there or not, and the kernel is compiled with and without.
#include <algorithm>

#include "engine/moving_body.h"
#include "models/rods/rod_poses.h"
#include "models/rods/rods.h"

namespace hairloom::runtime {
namespace {

Decision rodLength(const PlanBuilder&) {
    return {true, Reason::byRods, 0.0f};
}

Decision rodTorsion(const PlanBuilder& plan) {
    switch (rodPartsOf(plan.settings, plan.scene.straight)) {
        case RodParts::chain:
            return {false, Reason::noAngular, 0.0f};
        case RodParts::bending:
            return {false, Reason::straightHair, 0.0f};
        case RodParts::twist:
            return {true, Reason::curvedHair, 0.0f};
        case RodParts::section:
            return {true, Reason::flatSection, 0.0f};
    }
    return {};
}

Decision rodHairHair(const PlanBuilder& plan) {
    const bool on = plan.settings.hairHair;
    return {on, on ? Reason::authored : Reason::notAuthored, 1000.0f * plan.scene.hairCell};
}

Decision rodPose(const PlanBuilder& plan) {
    if (plan.scene.poses == 0) return {false, Reason::noPose, 0.0f};
    const float amount = plan.scene.poseAmount;
    return {amount > 0.0f, amount > 0.0f ? Reason::authored : Reason::zeroAmount, amount};
}

constexpr EffectRow kRodRows[] = {
    {Effect::damping, decideDamping},
    {Effect::gravity, decideGravity},
    {Effect::wind, decideWind},
    {Effect::drag, decideDrag},
    {Effect::length, rodLength},
    {Effect::angular, decideStiffness},
    {Effect::torsion, rodTorsion},
    {Effect::collision, decideCollision},
    {Effect::collisionRadius, decideCollisionRadius},
    {Effect::continuousCollision, decideContinuousCollision},
    {Effect::hairHair, rodHairHair},
    {Effect::pose, rodPose},
};

void listRodStages(PlanBuilder& plan) {
    if (plan.allAsleep()) return;
    plan.add(StageId::roots);
    plan.add(StageId::rod);
}

void fillRodNumbers(const SimulationSettings& settings, const EffectPlan& plan, SubstepContext& context) {
    context.numbers.set(rodNumbersOf(settings, plan));
}

float rodReach(const SimulationSettings&, float strandLength) {
    return strandLength;
}

Passes rodPasses(std::span<const StageId> stages, bool) {
    Passes passes;
    for (const StageId stage : stages)
        passes.calls[passes.count++] = stage == StageId::rod ? rodKernel().stage : kernels().roots;
    return passes;
}

std::size_t rodSolverFloats(std::span<const StageId> stages) {
    return stages.size() > 1 ? rodKernel().solverFloats : 0;
}

class RodStrands final : public ModelStrands {
  public:
    std::unique_ptr<ModelStrands> copy() const override { return std::make_unique<RodStrands>(*this); }

    void takeSettings(const RestShape& shape, const SimulationSettings& settings,
                      const SimulationSettings* before, State& state, const Host& host) override {
        // What rods rest in follows from no other settings.
        if (before && haveEqualRodEnergy(settings, *before)) return;
        rest_ = makeRodRest(shape, settings, host);
        posesAreOld_ = true;
        if (before && state.model == StrandModel::rods) forgetRodEnergy(shape, state);
    }

    void takeState(const RestShape& shape, const SimulationSettings&, State& state) override {
        completeRods(shape, rest_, rodTouchesOf(state), state);
    }

    void takeNewState(const RestShape& shape, const SimulationSettings&, State& state,
                      const Host& host) override {
        state.model = StrandModel::rods;
        allocateRods(shape, rest_.parts, {}, state, host);
    }

    void allocate(const RestShape& shape, const SimulationSettings&, const EffectPlan& plan, bool body,
                  State& state) override {
        allocateRods(shape, rest_.parts, {plan.on(Effect::collision) || body, body}, state);
    }
    void takePoses(const RestShape& shape, const SimulationSettings& settings, const PoseChange& change,
                   State& state, const Host& host) override {
        const bool followed = poses_.isOn();
        PoseChange known = change;
        known.others = known.others || posesAreOld_;
        poses_.take(shape, settings, rest_, known, host);
        posesAreOld_ = false;
        if (followed || poses_.isOn()) forgetRodEnergy(shape, state);
    }
    void forgetBody(State& state) const override {
        std::fill(state.own[kOwnFolds].begin(), state.own[kOwnFolds].end(), 0.0f);
    }

    void placeAtRest(const RestShape& shape, State& state, std::size_t index,
                     LaneRange lanes) const override {
        placeRodAtRest(shape, rest_, state, index, lanes);
    }
    void placeOnPoints(const RestShape& shape, State& state, std::size_t index,
                       std::uint32_t lane) const override {
        placeRodOnPoints(shape, rest_, state, index, lane);
    }

    BlockView& view(const RestShape& shape, State& state, std::size_t index, std::uint32_t clampedPoints,
                    BlockRoom& room) override {
        auto& block = room.make<RodBlock>();
        fillView(shape, state, index, clampedPoints, block);
        block.rod = rodViewOf(shape, rest_, state, index);
        poses_.show(shape.blocks[index], block.rod);
        return block;
    }

    void enterBlock(const RestShape& shape, const SimulationSettings& settings, const ModelFrame& frame,
                    std::size_t index, BlockView&, LaneFrame& lanes) const override {
        listTouchable(shape, settings, frame.context, index, lanes);
    }

    void turnAlong(const BlockView& view, std::size_t i, Quat turn) const override {
        const RodView& rod = static_cast<const RodBlock&>(view).rod;
        for (const Planes& planes : {rod.increment, rod.displacement, rod.velocity, rod.velocityBefore}) {
            const Float3 turned = rotate(turn, Float3{planes.x[i], planes.y()[i], planes.z()[i]});
            planes.x[i] = turned.x;
            planes.y()[i] = turned.y;
            planes.z()[i] = turned.z;
        }
        float* const x = rod.rotation + i;
        const std::size_t pitch = view.pitch;
        for (std::size_t plane = 0; rod.fold && plane < kFoldPlanes; ++plane)
            rod.fold[plane * pitch + i] = 0.0f;
        Quat q = turn * Quat{x[0], x[pitch], x[2 * pitch], x[3 * pitch]};
        normalize(q);
        x[0] = q.x;
        x[pitch] = q.y;
        x[2 * pitch] = q.z;
        x[3 * pitch] = q.w;
    }

    void addVelocity(const BlockView& view, std::size_t i, std::uint32_t lane, Float3 change) const override {
        const RodView& rod = static_cast<const RodBlock&>(view).rod;
        for (const Planes& velocity : {rod.velocity, rod.velocityBefore}) {
            velocity.x[i] += change.x;
            velocity.y()[i] += change.y;
            velocity.z()[i] += change.z;
        }
        rod.energy[lane] = kRodNoEnergy;
    }

    std::size_t effectBytes(Effect effect, const State& state) const override {
        switch (effect) {
            case Effect::angular:
                return planesBetween(RodParts::chain, RodParts::bending) + bytesOf(state.own[kOwnStrains]);
            case Effect::torsion:
                return planesBetween(RodParts::bending, RodParts::section) + rest_.curved.size();
            case Effect::collision:
                return bytesOf(state.own[kOwnLoads]);
            case Effect::pose:
                return poses_.bytes();
            default:
                return 0;  // has no memory of its own
        }
    }
    std::size_t baseBytes(const State& state) const override {
        return bytesOf(rest_.planes) / rest_.planeCount() * kRodRestPlanes[0] +
               bytesOf(state.own[kOwnMotion]) + bytesOf(state.own[kOwnLanes]) + bodyBytes(state);
    }
    std::size_t bodyBytes(const State& state) const override { return bytesOf(state.own[kOwnFolds]); }

  private:
    static std::size_t bytesOf(const Floats& values) { return values.size() * sizeof(float); }
    /// Bytes of the rest planes that `to` has and `from` has not, as far as there are such parts.
    std::size_t planesBetween(RodParts from, RodParts to) const {
        const auto count = [&](RodParts parts) {
            return kRodRestPlanes[static_cast<std::size_t>(std::min(parts, rest_.parts))];
        };
        return bytesOf(rest_.planes) / rest_.planeCount() * (count(to) - count(from));
    }

    RodRest rest_;
    RodPoses poses_;
    bool posesAreOld_ = false;  // since rest_ is another
};

}  // namespace

RodNumbers rodNumbersOf(const SimulationSettings& settings, const EffectPlan& plan) {
    RodNumbers numbers{};
    numbers.rootDamping = plan.on(Effect::damping) ? 1.0f / settings.dampingTime : 0.0f;
    numbers.bendDampingTime = settings.bendDampingTime;
    if (plan.on(Effect::torsion)) {
        const RodSectionRatios section = rodSectionRatios(settings);
        numbers.twist = static_cast<float>(section.twist);
        numbers.flat = static_cast<float>(section.flat);
    }
    return numbers;
}

const Model& rodModel() {
    static const Model kModel{
        .name = "rods",
        .effects = kRodRows,
        .listStages = listRodStages,
        .reach = rodReach,
        .fillNumbers = fillRodNumbers,
        .passes = rodPasses,
        .solverFloats = rodSolverFloats,
        .make = [] { return std::unique_ptr<ModelStrands>(std::make_unique<RodStrands>()); },
        .own = {{{.planes = kRodMotionPlanes},
                 {.planes = kRodStrainPlanes, .isOptional = true},
                 {.planes = 1, .isOptional = true},
                 {.laneRows = kRodLaneRows},
                 {.planes = kFoldPlanes, .isOptional = true}}},
        .laneFloats = 0,
        .listsSpheres = true,
        .meetsBody = true,
        .keepsVelocities = true,
        .mostPlanes = kRodRestPlanes[3] + kRodStatePlanes,
        .mostSolverFloats = [] { return rodKernel().solverFloats; },
        .posePlanes = RodPoses::planesOf,
        .gpuSource = "rods.hlsli",
    };
    return kModel;
}

}  // namespace hairloom::runtime
