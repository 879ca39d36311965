// SPDX-License-Identifier: MIT
// The plan: what all models decide alike; each model has the rest in its folder.
#include "hairloom/plan.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "engine/plan_builder.h"
#include "engine/strand_model.h"

namespace hairloom::runtime {
namespace {

/// Whether the sphere, anywhere on its way, can touch a point that hangs on a root inside the box.
bool withinReach(const Sphere& sphere, Float3 motion, const PlanInput& scene) {
    if (!(sphere.radius > 0.0f)) return false;
    const float reach = (hairReach(scene.settings, scene.longestStrand) + sphere.radius) * 1.001f;
    const Float3 from = sphere.center_ws - motion;
    const Float3 to = sphere.center_ws;
    const Float3 low = scene.rootsMin_ws;
    const Float3 high = scene.rootsMax_ws;
    const auto gap = [](float a, float b, float lo, float hi) {
        return std::max({lo - std::max(a, b), std::min(a, b) - hi, 0.0f});
    };
    const Float3 distance{gap(from.x, to.x, low.x, high.x), gap(from.y, to.y, low.y, high.y),
                          gap(from.z, to.z, low.z, high.z)};
    return dot(distance, distance) < reach * reach;
}

PlanBuilder::Reachable spheresWithinReach(const PlanInput& scene) {
    PlanBuilder::Reachable result;
    for (std::size_t i = 0; i < scene.spheres.size(); ++i) {
        const Float3 motion = scene.sphereMotion.empty() ? Float3{} : scene.sphereMotion[i];
        if (!withinReach(scene.spheres[i], motion, scene)) continue;
        ++result.count;
        result.smallest = std::min(result.smallest, scene.spheres[i].radius);
    }
    return result;
}

}  // namespace

void PlanBuilder::add(StageId stage) {
    assert(plan_.stageCount_ < kMaxStages);
    plan_.stages_[plan_.stageCount_++] = stage;
}

const PlanBuilder::Reachable& PlanBuilder::reachable() const {
    if (!reachable_) reachable_ = spheresWithinReach(scene);
    return *reachable_;
}

Decision decideSleep(const PlanBuilder& plan) {
    const PlanInput& scene = plan.scene;
    if (!(scene.settings.sleepSpeed > 0.0f)) return {false, Reason::neverAsleep, 0.0f};
    if (scene.asleep == 0) return {false, Reason::allAwake, 0.0f};
    if (scene.asleep < scene.strandCount) return {true, Reason::someAsleep, static_cast<float>(scene.asleep)};
    return {true, Reason::allAsleep, scene.restTime};
}

Decision decideDamping(const PlanBuilder& plan) {
    const float time = plan.settings.dampingTime;
    return {time > 0.0f, time > 0.0f ? Reason::authored : Reason::zeroTime, time};
}

Decision decideGravity(const PlanBuilder& plan) {
    const float gravity = length(plan.settings.gravity);
    return {gravity > 0.0f, gravity > 0.0f ? Reason::authored : Reason::zeroGravity, gravity};
}

Decision decideWind(const PlanBuilder& plan) {
    const SimulationSettings& s = plan.settings;
    if (!(s.windSpeed > 0.0f)) return {false, Reason::zeroSpeed, 0.0f};
    if (!(length(s.windDirection) > 0.0f)) return {false, Reason::noDirection, 0.0f};
    if (!(s.airDrag > 0.0f)) return {false, Reason::noAirDrag, 0.0f};
    return {true, Reason::authored, s.windSpeed};
}

Decision decideDrag(const PlanBuilder& plan) {
    const float drag = plan.settings.airDrag;
    if (!(drag > 0.0f)) return {false, Reason::noAirDrag, 0.0f};
    if (plan.on(Effect::wind)) return {false, Reason::windTakesOver, 0.0f};
    return {true, Reason::authored, drag};
}

Decision decideStiffness(const PlanBuilder& plan) {
    const float stiffest = greatestStiffness(plan.settings);
    return {stiffest > 0.0f, stiffest > 0.0f ? Reason::authored : Reason::zeroStiffness, stiffest};
}

Decision decideCollision(const PlanBuilder& plan) {
    if (plan.scene.spheres.empty()) return {false, Reason::noSpheres, 0.0f};
    const std::uint32_t count = plan.reachable().count;
    return {count > 0, count > 0 ? Reason::inReach : Reason::noneInReach, static_cast<float>(count)};
}

Decision decideCollisionRadius(const PlanBuilder& plan) {
    if (!plan.on(Effect::collision)) return {false, Reason::noCollision, 0.0f};
    const float largest = std::max(plan.settings.collisionRadiusRoot, plan.settings.collisionRadiusTip);
    if (!(largest > 0.0f)) return {false, Reason::zeroRadius, 0.0f};
    return {true, Reason::authored, 1000.0f * largest};
}

Decision decideContinuousCollision(const PlanBuilder& plan) {
    if (!plan.on(Effect::collision)) return {false, Reason::noCollision, 0.0f};
    const float fastest = plan.scene.fastest;
    if (!std::isfinite(fastest)) return {true, Reason::speedUnknown, 0.0f};
    // A slower point that passes cuts at most 0.8 % of the radius.
    if (fastest < 0.25f * plan.reachable().smallest) return {false, Reason::slowEnough, 0.0f};
    return {true, Reason::fast, 1000.0f * fastest};
}

float hairReach(const SimulationSettings& settings, float strandLength) {
    return modelOf(settings.strandModel).reach(settings, strandLength) +
           std::max(settings.collisionRadiusRoot, settings.collisionRadiusTip);
}

EffectPlan plan(const PlanInput& scene) {
    PlanBuilder builder(scene);
    builder.decide(Effect::sleep, decideSleep(builder));
    if (scene.strandCount == 0 || scene.longestPointCount <= scene.settings.clampedPoints) {
        builder.add(StageId::roots);
        return builder.plan();
    }
    const Model& model = modelOf(scene.settings.strandModel);
    for (const EffectRow& row : model.effects) builder.decide(row.effect, row.decide(builder));
    model.listStages(builder);
    return builder.plan();
}

}  // namespace hairloom::runtime
