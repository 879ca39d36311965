// SPDX-License-Identifier: MIT
#pragma once
// What a model decides its effects from and lists its stages with, and the decisions that models share.

#include <cstdint>
#include <optional>

#include "hairloom/plan.h"

namespace hairloom::runtime {

class PlanBuilder {
  public:
    explicit PlanBuilder(const PlanInput& of) : scene(of), settings(of.settings) {}

    const PlanInput& scene;
    const SimulationSettings& settings;

    /// No stage runs.
    bool allAsleep() const { return plan_.reason(Effect::sleep) == Reason::allAsleep; }
    /// Of an effect that was decided before.
    bool on(Effect effect) const { return plan_.on(effect); }
    void decide(Effect effect, Decision decision) {
        plan_.decisions_[static_cast<std::size_t>(effect)] = decision;
    }
    void add(StageId stage);
    /// EffectPlan::factored() and keepsTensions().
    void solves(bool factored, bool keepsTensions) {
        plan_.factored_ = factored;
        plan_.keepsTensions_ = keepsTensions;
    }
    const EffectPlan& plan() const { return plan_; }

    struct Reachable {
        std::uint32_t count = 0;
        float smallest = 1e30f;  ///< radius, metres
    };
    /// Spheres that can touch hair in this frame.
    const Reachable& reachable() const;

  private:
    EffectPlan plan_;
    mutable std::optional<Reachable> reachable_;
};

// Each needs those before it.
Decision decideSleep(const PlanBuilder& plan);
Decision decideDamping(const PlanBuilder& plan);
Decision decideGravity(const PlanBuilder& plan);
Decision decideWind(const PlanBuilder& plan);
Decision decideDrag(const PlanBuilder& plan);
Decision decideStiffness(const PlanBuilder& plan);
Decision decideCollision(const PlanBuilder& plan);
Decision decideCollisionRadius(const PlanBuilder& plan);
Decision decideContinuousCollision(const PlanBuilder& plan);

}  // namespace hairloom::runtime
