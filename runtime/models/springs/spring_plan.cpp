// SPDX-License-Identifier: MIT
// What springs run: their effects, and the stages of the integrators.
#include "models/springs/spring_plan.h"

namespace hairloom::runtime {
namespace {

bool hasCoils(const SimulationSettings& s) {
    return s.lengthMethod != LengthMethod::constraint;
}

/// Angular springs solved as a stage after position Verlet.
bool bendsImplicitly(const SimulationSettings& s) {
    return s.integrator == Integrator::verlet && s.angularMethod == AngularMethod::implicit;
}

Decision springLength(const PlanBuilder& plan) {
    const SimulationSettings& s = plan.settings;
    if (hasCoils(s)) return {true, Reason::springsOn, s.springFrequency};
    if (s.lengthIterations == 0) return {false, Reason::zeroIterations, 0.0f};
    return {true, Reason::authored, static_cast<float>(s.lengthIterations)};
}

Decision springTorsion(const PlanBuilder& plan) {
    if (!plan.on(Effect::angular)) return {false, Reason::noAngular, 0.0f};
    if (plan.settings.angularMethod == AngularMethod::flexion) return {false, Reason::noFrames, 0.0f};
    if (plan.scene.straight) return {false, Reason::straightHair, 0.0f};
    return {true, Reason::curvedHair, 0.0f};
}

Decision springSweeps(const PlanBuilder& plan) {
    if (plan.on(Effect::collision) && plan.settings.collisionResponse == CollisionResponse::penalty)
        return {false, Reason::byForce, 0.0f};
    return decideContinuousCollision(plan);
}

StageId angularForce(const PlanBuilder& plan) {
    const bool frames = plan.on(Effect::torsion);
    switch (plan.settings.angularMethod) {
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

StageId implicitStep(const PlanBuilder& plan) {
    const bool angular = plan.on(Effect::angular) && plan.settings.angularMethod != AngularMethod::flexion;
    if (hasCoils(plan.settings)) return angular ? StageId::implicitSpringBend : StageId::implicitSpring;
    return angular ? StageId::implicitBend : StageId::implicitFree;
}

/// Air first: it is the only force that reads velocities, which the others then change.
void listForces(PlanBuilder& plan) {
    const SimulationSettings& s = plan.settings;
    if (plan.on(Effect::drag)) plan.add(StageId::drag);
    if (plan.on(Effect::wind)) plan.add(StageId::wind);
    if (plan.on(Effect::gravity)) plan.add(StageId::gravity);
    if (hasCoils(s)) plan.add(StageId::springs);
    if (plan.on(Effect::angular) && !bendsImplicitly(s)) plan.add(angularForce(plan));
    if (plan.on(Effect::collision) && s.collisionResponse == CollisionResponse::penalty)
        plan.add(StageId::penalty);
}

void listConstraints(PlanBuilder& plan) {
    const SimulationSettings& s = plan.settings;
    const bool held = !hasCoils(s) && s.lengthIterations > 0;
    // Tension along the segments at the start of the substep is more exact, but pumps the leapfrog and
    // outruns what the backward Euler step has damped.
    const bool now = s.integrator == Integrator::leapfrog || s.integrator == Integrator::implicitEuler;
    if (held) plan.add(now ? StageId::lengthNow : StageId::length);
    if (s.lengthMethod == LengthMethod::springVelocities && s.lengthIterations > 0)
        plan.add(StageId::springLimit);
    if (plan.on(Effect::continuousCollision)) plan.add(StageId::continuousCollision);
    if (plan.on(Effect::collision) && s.collisionResponse != CollisionResponse::penalty) {
        plan.add(s.collisionResponse == CollisionResponse::radial ? StageId::collision
                                                                  : StageId::collisionBack);
    }
    if (s.lengthIterations > 0 && s.lengthMethod != LengthMethod::springVelocities)
        plan.add(StageId::extension);
}

void listRateProjection(PlanBuilder& plan) {
    if (!hasCoils(plan.settings) && plan.settings.lengthIterations > 0) plan.add(StageId::lengthRate);
}

constexpr EffectRow kSpringRows[] = {
    {Effect::damping, decideDamping},
    {Effect::gravity, decideGravity},
    {Effect::wind, decideWind},
    {Effect::drag, decideDrag},
    {Effect::length, springLength},
    {Effect::angular, decideStiffness},
    {Effect::torsion, springTorsion},
    {Effect::collision, decideCollision},
    {Effect::collisionRadius, decideCollisionRadius},
    {Effect::continuousCollision, springSweeps},
    {Effect::hairHair,
     [](const PlanBuilder&) {
         return Decision{false, Reason::ofRodsAlone, 0.0f};
     }},
    {Effect::pose,
     [](const PlanBuilder&) {
         return Decision{false, Reason::noPoseOfSprings, 0.0f};
     }},
};

}  // namespace

std::span<const EffectRow> springEffects() {
    return kSpringRows;
}

void listSpringStages(PlanBuilder& plan) {
    const SimulationSettings& s = plan.settings;
    const bool stiff = plan.on(Effect::angular);
    plan.solves(stiff && s.angularMethod != AngularMethod::flexion &&
                    (bendsImplicitly(s) || (s.integrator == Integrator::implicitEuler && !hasCoils(s))),
                stiff && bendsImplicitly(s) && !hasCoils(s) && s.lengthIterations > 0);
    if (plan.allAsleep()) return;
    plan.add(StageId::roots);
    if (plan.on(Effect::damping)) plan.add(StageId::damping);
    switch (s.integrator) {
        case Integrator::verlet:
            listForces(plan);
            plan.add(StageId::verlet);
            if (plan.on(Effect::angular) && bendsImplicitly(s))
                plan.add(plan.on(Effect::torsion) ? StageId::angular : StageId::angularStraight);
            break;
        case Integrator::velocityVerlet:
            plan.add(StageId::open);
            listForces(plan);
            plan.add(StageId::verletDrift);
            listConstraints(plan);
            plan.add(StageId::verletEvaluationState);
            listForces(plan);
            plan.add(StageId::verletKick);
            listRateProjection(plan);
            return;
        case Integrator::leapfrog:
            plan.add(StageId::openHalfway);
            listForces(plan);
            plan.add(StageId::leapfrog);
            break;
        case Integrator::explicitEuler:
            plan.add(StageId::open);
            listForces(plan);
            plan.add(StageId::explicitEuler);
            break;
        case Integrator::implicitEuler:
            plan.add(StageId::open);
            listForces(plan);
            plan.add(implicitStep(plan));
            break;
        case Integrator::rk4:
            plan.add(StageId::open);
            for (const StageId slope :
                 {StageId::rungeKutta1, StageId::rungeKutta2, StageId::rungeKutta3, StageId::rungeKutta4}) {
                listForces(plan);
                plan.add(slope);
            }
            break;
    }
    listConstraints(plan);
    if (s.integrator != Integrator::verlet && s.integrator != Integrator::implicitEuler)
        listRateProjection(plan);
}

}  // namespace hairloom::runtime
