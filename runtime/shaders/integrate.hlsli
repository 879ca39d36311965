// SPDX-License-Identifier: MIT
// Integrators (docs/engine.md).

/// Slows motion relative to the moving root. First in a substep, so that it acts on velocity alone.
void stageDamping() {
    const float lost = 1.0 - gFrame.substep.velocityShare;
    MOVED_POINTS(p)
        setPrevious(p, previous(p) + (position(p) - previous(p) - gRootDisplacement) * (lost * freedom(p)));
}

/// Position Verlet (Rünz 2012, Eq. 10). From rest the first step is x₁ = x₀ + ½ a h².
void stageVerlet() {
    const float share = gSubstep == 0 ? gFrame.firstShare : 1.0;
    MOVED_POINTS(p) {
        const float3 here = position(p);
        const float3 from = here - gRootDisplacement;
        setFreePosition(p, from + (here - previous(p)) * share);
        setFreePrevious(p, from);
    }
}

#if HAIR_EVALUATION >= 1
/// The next evaluation of forces is at `here`, with the displacement `moving` for velocity.
void setEvaluationState(uint p, float3 here, float3 moving) {
    setPosition(p, here);
    setPrevious(p, here - moving);
}

/// What the forces have added since setEvaluationState().
float3 takeKick(uint p, float3 moving) {
    return pointOf(p) < FIRST_FREE ? float3(0, 0, 0) : position(p) - previous(p) - moving;
}

/// Keeps where the substep starts, relative to the root at its end, and the displacement of the last one;
/// that of a clamped point is its displacement in this substep. Forces are evaluated after `share` of it.
void open(float share) {
    ALL_POINTS(p) {
        const float3 here = position(p);
        const float3 before = previous(p);
        const float3 moving = here - before;
        const float3 from = pointOf(p) < FIRST_FREE ? before : here - gRootDisplacement;
        setStart(p, from);
        setStepDisplacement(p, moving);
        setEvaluationState(p, from + moving * share, moving);
    }
}
void stageOpen() { open(0.0); }
void stageOpenHalfway() { open(0.5); }

/// Explicit Euler (Eq. 7): the way of the old velocity.
void stageExplicitEuler() {
    ALL_POINTS(p) {
        const float3 moving = stepDisplacement(p);
        setEvaluationState(p, start(p) + moving, moving + takeKick(p, moving));
    }
}

/// Drift-kick-drift: the second half drift after the kick halfway.
void stageLeapfrog() {
    ALL_POINTS(p) {
        const float3 moving = stepDisplacement(p);
        const float3 after = moving + takeKick(p, moving);
        setEvaluationState(p, start(p) + (moving + after) * 0.5, after);
    }
}

/// Velocity Verlet (Eq. 12), first half kick and drift.
void stageVerletDrift() {
    ALL_POINTS(p) {
        const float3 moving = stepDisplacement(p);
        const float3 half_ = moving + takeKick(p, moving) * 0.5;
        setEvaluationState(p, start(p) + half_, half_);
    }
}

/// Velocity Verlet: forces see where the constraints have put the points and the velocity predicted for the
/// end of the step; `start` keeps it.
void stageVerletEvaluationState() {
    ALL_POINTS(p) {
        const float3 here = position(p);
        const float3 half_ = here - previous(p);
        const float3 predicted = half_ + half_ - stepDisplacement(p);
        setStepDisplacement(p, half_);
        setStart(p, predicted);
        setEvaluationState(p, here, predicted);
    }
}

/// Velocity Verlet, second half kick.
void stageVerletKick() {
    ALL_POINTS(p)
        setEvaluationState(p, position(p), stepDisplacement(p) + takeKick(p, start(p)) * 0.5);
}
#endif

#if HAIR_EVALUATION == 2
/// The classical Runge-Kutta method. With A_k what the forces give at slope k, the velocities are u, u + A₁/2,
/// u + A₂/2 and u + A₃, so the positions need only sums of A.
void stageRungeKutta1() {
    ALL_POINTS(p) {
        const float3 moving = stepDisplacement(p);
        const float3 added = takeKick(p, moving);
        setKick(p, added);
        setSum(p, added);
        setStepDisplacementSum(p, added);
        setEvaluationState(p, start(p) + moving * 0.5, moving + added * 0.5);
    }
}
void stageRungeKutta2() {
    ALL_POINTS(p) {
        const float3 moving = stepDisplacement(p), here = moving + kick(p) * 0.5;
        const float3 added = takeKick(p, here);
        setKick(p, added);
        setSum(p, sum(p) + added);
        setStepDisplacementSum(p, stepDisplacementSum(p) + added + added);
        setEvaluationState(p, start(p) + here * 0.5, moving + added * 0.5);
    }
}
void stageRungeKutta3() {
    ALL_POINTS(p) {
        const float3 moving = stepDisplacement(p), here = moving + kick(p) * 0.5;
        const float3 added = takeKick(p, here);
        setKick(p, added);
        setSum(p, sum(p) + added);
        setStepDisplacementSum(p, stepDisplacementSum(p) + added + added);
        setEvaluationState(p, start(p) + here, moving + added);
    }
}
void stageRungeKutta4() {
    ALL_POINTS(p) {
        const float3 moving = stepDisplacement(p);
        const float3 added = takeKick(p, moving + kick(p));
        setEvaluationState(p, start(p) + moving + sum(p) * (1.0 / 6.0), moving + (stepDisplacementSum(p) + added) * (1.0 / 6.0));
    }
}
#endif
