// SPDX-License-Identifier: MIT
#include "hairloom/plan.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <initializer_list>
#include <limits>

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

struct Reachable {
    std::uint32_t count = 0;
    float smallest = 1e30f;  ///< radius, metres
};

Reachable spheresWithinReach(const PlanInput& scene) {
    Reachable result;
    for (std::size_t i = 0; i < scene.spheres.size(); ++i) {
        const Float3 motion = scene.sphereMotion.empty() ? Float3{} : scene.sphereMotion[i];
        if (!withinReach(scene.spheres[i], motion, scene)) continue;
        ++result.count;
        result.smallest = std::min(result.smallest, scene.spheres[i].radius);
    }
    return result;
}

Decision decideWind(const SimulationSettings& s) {
    if (!(s.windSpeed > 0.0f)) return {false, Reason::zeroSpeed, 0.0f};
    if (!(length(s.windDirection) > 0.0f)) return {false, Reason::noDirection, 0.0f};
    if (!(s.airDrag > 0.0f)) return {false, Reason::noAirDrag, 0.0f};
    return {true, Reason::authored, s.windSpeed};
}

Decision decideDrag(const SimulationSettings& s, bool wind) {
    if (!(s.airDrag > 0.0f)) return {false, Reason::noAirDrag, 0.0f};
    if (wind) return {false, Reason::windTakesOver, 0.0f};
    return {true, Reason::authored, s.airDrag};
}

Decision decideLength(const SimulationSettings& s) {
    if (s.strandModel == StrandModel::rods) return {true, Reason::byRods, 0.0f};
    if (s.lengthMethod != LengthMethod::constraint) return {true, Reason::springsOn, s.springFrequency};
    if (s.lengthIterations == 0) return {false, Reason::zeroIterations, 0.0f};
    return {true, Reason::authored, static_cast<float>(s.lengthIterations)};
}

Decision decideTorsion(const PlanInput& scene, bool angular, bool held) {
    if (!angular) return {false, Reason::noAngular, 0.0f};
    if (scene.settings.strandModel == StrandModel::rods)
        return scene.straight && !held ? Decision{false, Reason::straightHair, 0.0f}
                                       : Decision{true, Reason::curvedHair, 0.0f};
    if (scene.settings.angularMethod == AngularMethod::flexion) return {false, Reason::noFrames, 0.0f};
    if (scene.straight && !held) return {false, Reason::straightHair, 0.0f};
    return {true, Reason::curvedHair, 0.0f};
}

Decision decideCollisionRadius(const SimulationSettings& s, bool collision) {
    if (!collision) return {false, Reason::noCollision, 0.0f};
    const float largest = std::max(s.collisionRadiusRoot, s.collisionRadiusTip);
    if (!(largest > 0.0f)) return {false, Reason::zeroRadius, 0.0f};
    return {true, Reason::authored, 1000.0f * largest};
}

Decision decideContinuousCollision(const PlanInput& scene, bool collision, float smallestSphere) {
    if (!collision) return {false, Reason::noCollision, 0.0f};
    if (scene.settings.strandModel == StrandModel::springs &&
        scene.settings.collisionResponse == CollisionResponse::penalty)
        return {false, Reason::byForce, 0.0f};
    if (!std::isfinite(scene.fastest)) return {true, Reason::speedUnknown, 0.0f};
    // A slower point that passes cuts at most 0.8 % of the radius.
    if (scene.fastest < 0.25f * smallestSphere) return {false, Reason::slowEnough, 0.0f};
    return {true, Reason::fast, 1000.0f * scene.fastest};
}

Decision decideSleep(const PlanInput& scene) {
    if (!(scene.settings.sleepSpeed > 0.0f)) return {false, Reason::neverAsleep, 0.0f};
    if (scene.asleep == 0) return {false, Reason::allAwake, 0.0f};
    if (scene.asleep < scene.strandCount) return {true, Reason::someAsleep, static_cast<float>(scene.asleep)};
    return {true, Reason::allAsleep, scene.restTime};
}

}  // namespace

/// Decides effect after effect, then lists the stages.
class Planner {
  public:
    explicit Planner(const PlanInput& scene) : scene_(scene), s_(scene.settings) {}

    EffectPlan make() {
        decide(Effect::sleep, decideSleep(scene_));
        if (scene_.strandCount == 0 || scene_.longestPointCount <= s_.clampedPoints) {
            add(StageId::roots);
            return plan_;
        }
        decideEffects();
        if (plan_.reason(Effect::sleep) != Reason::allAsleep) listStages();
        return plan_;
    }

  private:
    bool on(Effect effect) const { return plan_.on(effect); }
    void add(StageId stage) {
        assert(plan_.stageCount_ < kMaxStages);
        plan_.stages_[plan_.stageCount_++] = stage;
    }
    void add(std::initializer_list<StageId> stages) {
        for (const StageId stage : stages) add(stage);
    }
    bool decide(Effect effect, Decision decision) {
        plan_.decisions_[static_cast<std::size_t>(effect)] = decision;
        return decision.on;
    }

    void decideEffects() {
        const bool damped = s_.dampingTime > 0.0f;
        decide(Effect::damping, {damped, damped ? Reason::authored : Reason::zeroTime, s_.dampingTime});
        const float gravity = length(s_.gravity);
        decide(Effect::gravity,
               {gravity > 0.0f, gravity > 0.0f ? Reason::authored : Reason::zeroGravity, gravity});
        const bool wind = decide(Effect::wind, decideWind(s_));
        decide(Effect::drag, decideDrag(s_, wind));
        decide(Effect::length, decideLength(s_));
        const float stiffest = greatestStiffness(s_);
        const bool stiff = stiffest > 0.0f;
        decide(Effect::angular, {stiff, stiff ? Reason::authored : Reason::zeroStiffness, stiffest});
        const bool held = rods() && gravity > 0.0f && s_.restGravity > 0.0f;
        decide(Effect::torsion, decideTorsion(scene_, stiff, held));
        decideCollision();
        plan_.keepsTensions_ = !rods() && stiff && implicitly() && !coils() && s_.lengthIterations > 0;
        plan_.factored_ = !rods() && stiff && s_.angularMethod != AngularMethod::flexion &&
                          (implicitly() || (s_.integrator == Integrator::implicitEuler && !coils()));
    }

    void decideCollision() {
        if (scene_.spheres.empty()) {
            decide(Effect::collision, {false, Reason::noSpheres, 0.0f});
        } else {
            const Reachable reachable = spheresWithinReach(scene_);
            smallestSphere_ = reachable.smallest;
            decide(Effect::collision,
                   {reachable.count > 0, reachable.count > 0 ? Reason::inReach : Reason::noneInReach,
                    static_cast<float>(reachable.count)});
        }
        const bool collision = on(Effect::collision);
        decide(Effect::collisionRadius, decideCollisionRadius(s_, collision));
        decide(Effect::continuousCollision, decideContinuousCollision(scene_, collision, smallestSphere_));
    }

    bool rods() const { return s_.strandModel == StrandModel::rods; }
    bool coils() const { return s_.lengthMethod != LengthMethod::constraint; }
    /// Angular springs solved as a stage after position Verlet.
    bool implicitly() const {
        return s_.integrator == Integrator::verlet && s_.angularMethod == AngularMethod::implicit;
    }

    /// Air first: it is the only force that reads velocities, which the others then change.
    void listForces() {
        if (on(Effect::drag)) add(StageId::drag);
        if (on(Effect::wind)) add(StageId::wind);
        if (on(Effect::gravity)) add(StageId::gravity);
        if (coils()) add(StageId::springs);
        if (on(Effect::angular) && !implicitly()) add(angularForce());
        if (on(Effect::collision) && s_.collisionResponse == CollisionResponse::penalty)
            add(StageId::penalty);
    }
    StageId angularForce() const {
        const bool frames = on(Effect::torsion);
        switch (s_.angularMethod) {
            case AngularMethod::flexion:
                return StageId::flexion;
            case AngularMethod::exact:
                return frames ? StageId::angularExact : StageId::straightExact;
            case AngularMethod::implicit:
            case AngularMethod::smallAngle:
                break;
        }
        return frames ? StageId::angularSmallAngle : StageId::straightSmallAngle;
    }

    StageId implicitStep() const {
        const bool angular = on(Effect::angular) && s_.angularMethod != AngularMethod::flexion;
        if (coils()) return angular ? StageId::implicitSpringBend : StageId::implicitSpring;
        return angular ? StageId::implicitBend : StageId::implicitFree;
    }

    void listStages() {
        add(StageId::roots);
        if (rods()) {
            add(StageId::rod);
            return;
        }
        if (on(Effect::damping)) add(StageId::damping);
        switch (s_.integrator) {
            case Integrator::verlet:
                listForces();
                add(StageId::verlet);
                if (on(Effect::angular) && implicitly())
                    add(on(Effect::torsion) ? StageId::angular : StageId::angularStraight);
                break;
            case Integrator::velocityVerlet:
                add(StageId::open);
                listForces();
                add(StageId::verletDrift);
                listConstraints();
                add(StageId::verletEvaluationState);
                listForces();
                add(StageId::verletKick);
                listRateProjection();
                return;
            case Integrator::leapfrog:
                add(StageId::openHalfway);
                listForces();
                add(StageId::leapfrog);
                break;
            case Integrator::explicitEuler:
                add(StageId::open);
                listForces();
                add(StageId::explicitEuler);
                break;
            case Integrator::implicitEuler:
                add(StageId::open);
                listForces();
                add(implicitStep());
                break;
            case Integrator::rk4:
                add(StageId::open);
                for (const StageId slope : {StageId::rungeKutta1, StageId::rungeKutta2, StageId::rungeKutta3,
                                            StageId::rungeKutta4}) {
                    listForces();
                    add(slope);
                }
                break;
        }
        listConstraints();
        if (s_.integrator != Integrator::verlet && s_.integrator != Integrator::implicitEuler)
            listRateProjection();
    }

    void listConstraints() {
        const bool held = !coils() && s_.lengthIterations > 0;
        // Tension along the segments at the start of the substep is more exact, but pumps the leapfrog and
        // outruns what the backward Euler step has damped.
        const bool now = s_.integrator == Integrator::leapfrog || s_.integrator == Integrator::implicitEuler;
        if (held) add(now ? StageId::lengthNow : StageId::length);
        if (s_.lengthMethod == LengthMethod::springVelocities && s_.lengthIterations > 0)
            add(StageId::springLimit);
        if (on(Effect::continuousCollision)) add(StageId::continuousCollision);
        if (on(Effect::collision) && s_.collisionResponse != CollisionResponse::penalty) {
            add(s_.collisionResponse == CollisionResponse::radial ? StageId::collision
                                                                  : StageId::collisionBack);
        }
        if (s_.lengthIterations > 0 && s_.lengthMethod != LengthMethod::springVelocities)
            add(StageId::extension);
    }
    void listRateProjection() {
        if (!coils() && s_.lengthIterations > 0) add(StageId::lengthRate);
    }

    const PlanInput& scene_;
    const SimulationSettings& s_;
    EffectPlan plan_;
    float smallestSphere_ = 0.0f;
};

float hairReach(const SimulationSettings& settings, float strandLength) {
    const bool rods = settings.strandModel == StrandModel::rods;
    if (!rods && settings.lengthIterations == 0) return std::numeric_limits<float>::infinity();
    return strandLength * (1.0f + (rods ? 0.0f : settings.maximalExtension)) +
           std::max(settings.collisionRadiusRoot, settings.collisionRadiusTip);
}

EffectPlan plan(const PlanInput& scene) {
    return Planner(scene).make();
}

}  // namespace hairloom::runtime
