// SPDX-License-Identifier: MIT
// A substep of elastic rods (docs/engine.md, "Rods"): a prediction, one elimination from tip to root, one pass back, and
// the guards that keep the objective from rising. As runtime/models/rods/rod-inl.h.

#define FIRST_SEGMENT (HAIR_CLAMPED - 1)
#define SEGMENTS (POINTS - 1)
#define EACH_SEGMENT(j) [loop] for (uint j = FIRST_SEGMENT; j < SEGMENTS; ++j)

static float gStepRatio;         // of this substep
static float gBlend;             // c of the time scheme
static float gVelocityAhead;     // share of the last change of velocity that is expected again
static float gTimeStep, gInverseTimeStep;
static float gDamped, gDampingShare;  // 1 + τ/h, and the part of it that is damping
static float3 gInDisplacement;   // of the first free segment's inner node
static float4 gInner;            // rotation of the segment before it
static bool gStill;              // nothing adds energy
static bool gGuarded;            // in this frame: speeds were taken back
static bool gPredicts;           // the last substep's rotations are repeated
static float gObjective, gStartObjective, gStiffnessSum;

float3 rootAtEnd() { return mad3(gRootDisplacement, float(gSubstep + 1), gRoot); }
/// Of the inner node of the first free segment, relative to the root.
float3 firstPosition() {
#if HAIR_CLAMPED > 1
    return rodRotate(gInner, restTangent(0)) * segmentLength(0);
#else
    return float3(0, 0, 0);
#endif
}

/// The rounding error of an elastic energy: strains are wrong by about one unit in the last place.
float roundingOf(float energy) { return 4.0 * HAIRLOOM_ROD_ROUNDING * sqrt(abs(energy + energy) * gStiffnessSum); }

/// The time scheme: y = x + c (x − x₋), backward differences of second order with c = r²/(1 + 2r) for steps of the
/// ratio r, backward Euler with c = 0.
void openRodStep() {
    gStepRatio = gSubstep == 0 ? gRod.stepRatio : 1.0;
    float most = 0.0;
    if (gStepRatio < HAIRLOOM_ROD_LONGEST_RATIO) most = gStepRatio * gStepRatio / (1.0 + 2.0 * gStepRatio);
    gBlend = most * min(max(negMad(largestTurn(), HAIRLOOM_ROD_BLEND_SLOPE, HAIRLOOM_ROD_BLEND_END), 0.0), 1.0);
    gVelocityAhead = gBlend * (1.0 / gStepRatio + 2.0);
    gTimeStep = gFrame.h * (1.0 - gBlend / gStepRatio);
    gInverseTimeStep = 1.0 / gTimeStep;
    gDamped = rodDamped(gRod.numbers, gInverseTimeStep);
    gDampingShare = (gDamped - 1.0) / gDamped;
    gInner = gRotation;
    gInDisplacement = gRootDisplacement;
#if HAIR_CLAMPED > 1
    // The clamped segment turns with its root; where only the root is held, the frame that stands for one.
    const float3 along = restTangent(0);
    gInDisplacement = mad3(rodRotate(gInner, along) - rodRotate(rotation(0), along), segmentLength(0), gRootDisplacement);
    setRotation(0, gInner);
#endif
    const float4 turned = abs(gRotationFrom - (dot(gRotationFrom, gRotationTo) < 0.0 ? -gRotationTo : gRotationTo));
    const float moved = dot(gRootDisplacement, gRootDisplacement) + turned.x + turned.y + turned.z + turned.w;
    gStill = moved <= 0.0 && gRod.conservative != 0u;
}

/// Where inertia, gravity and air take a node, which the prediction has at `position`; w: its weight m/(h² D).
float4 aim(uint node, float3 tangent, float3 position) {
    const float3 now = velocity(node), faster = now - velocityBefore(node);
    float3 change = mad3(gRod.gravity.xyz, gTimeStep, mad3(faster, gBlend, now));
    float rate = gRod.numbers.rootDamping;
    change = mad3(gRootDisplacement, gRod.numbers.rootDamping / gFrame.h * gTimeStep, change);
    if (gRod.gravity.w > 0.0) {
        float3 air = float3(0, 0, 0);
#if HAIR_WIND
        air = windAt(position + rootAtEnd(), gFrame.substeps - 1 - gSubstep);
#endif
        // Hair takes on the air's velocity at the rate airDrag · sin of its angle to the tangent (Rünz 2012, Section 3.3);
        // velocity and tangent are predicted for the end of the substep, so that the scheme keeps its order.
        const float3 flow = air - mad3(faster, gVelocityAhead, now);
        const float all2 = dot(flow, flow), parallel = dot(flow, tangent);
        const float drag = sqrt(max(negMad(parallel, parallel, all2), 0.0) / max(all2, 1e-30)) * gRod.gravity.w;
        rate += drag;
        change = mad3(air, drag * gTimeStep, change);
    }
    const float slowed = mad(rate, gTimeStep, 1.0);
    return float4(mad3(displacement(node), gBlend, change * (gTimeStep / slowed)),
                  mass(node) * gInverseTimeStep * gInverseTimeStep * slowed);
}

#if HAIR_SPHERES
static float gTouched;  // most of RodContact::touching
static bool gNear;      // a shape is near some node

RodNode nodeOf(uint p, float3 moved, float3 tangent, float3 position, float weight) {
    RodNode node;
    node.position = position;
    node.displacement = moved;
    node.tangent = tangent;
    node.velocity = velocity(p);
    node.faster = node.velocity - velocityBefore(p);
    node.weight = weight;
    node.stiffness = mass(p) * (HAIRLOOM_ROD_CONTACT / (gFrame.h * gFrame.h));
    node.load = load(p);
    node.step = gTimeStep;
    node.radius = collisionRadiusAt(p);
    return node;
}

/// The contacts of segment j's outer node, as predicted.
RodContact meet(uint j, RodNode node) {
    RodContact found = noContact();
    bool near = false;
    EACH_SPHERE(k) {
        RodTouch touch;
        if (touchSphere(k, rootAtEnd(), node, touch)) {
            near = true;
            press(touch, rodHolds(touch, rodSlackAfter(node.load)), node, found);
        }
    }
    gTouched = max(gTouched, found.touching);
    gNear = gNear || near;
    setNear(j, near);
    setContact(j, found);
    return found;
}
#endif

/// Repeats the last substep's rotations where gPredicts, and finds the objective there and where nothing turns.
void predict() {
    float3 outer = gInDisplacement, position = firstPosition();
    float4 before = gInner;
    gObjective = gStartObjective = gStiffnessSum = 0.0;
#if HAIR_SPHERES
    gTouched = 0.0;
    gNear = false;
#endif
    EACH_SEGMENT(j) {
        const float4 old = rotation(j), rest = restTangentAndBend(j);
        const float3 oldTangent = rodRotate(old, rest.xyz);
        float3 u = increment(j) * gStepRatio;
        const float squared = dot(u, u);
        if (squared > HAIRLOOM_ROD_LARGEST_PREDICTION * HAIRLOOM_ROD_LARGEST_PREDICTION)
            u *= HAIRLOOM_ROD_LARGEST_PREDICTION / sqrt(squared);
        if (!gPredicts) u = float3(0, 0, 0);
        const float along = segmentLength(j);
        outer = mad3(rodTangentChange(u, oldTangent), along, outer);
        const float4 q = rodTurned(old, u);
        const float3 tangent = rodRotate(q, rest.xyz);
        position = mad3(tangent, along, position);
        const float4 aimed = aim(j + 1, tangent, position);

        // Damping pulls to the strain extrapolated from the last two substeps (Kelvin-Voigt), elasticity to none.
        const float3 last = strain(j);
        const float3 wanted = mad3(last - strainBefore(j), gBlend, last) * gDampingShare;
        const float4 side = rodOfStrain(last), relative = rodRelative(before, q, side);
        const float bend = rest.w * gDamped;
        const RodSection resists = section(j, bend);
        gStiffnessSum += bend;
        const float3 off = outer - aimed.xyz, offStart = gInDisplacement - aimed.xyz;
        gObjective += rodTwiceEnergy(twice(relative) - wanted, bend, resists) + aimed.w * dot(off, off);
        float3 strainStart = last;
        if (j == FIRST_SEGMENT) strainStart = twice(rodRelative(gInner, old, side));
        gStartObjective += rodTwiceEnergy(strainStart - wanted, bend, resists) + aimed.w * dot(offStart, offStart);
        setPredictedRotation(j, q);
        setPredictedRelative(j, relative);
        setWantedStrain(j, wanted);
        setPredictedIncrement(j, u);
        setPredictedDisplacement(j, outer);
        setTarget(j, aimed);
#if HAIR_SPHERES
        if (gReachable != 0u) {
            const RodContact met = meet(j, nodeOf(j + 1, outer, tangent, position, aimed.w));
            gObjective += met.twiceEnergy;
            gStartObjective += rodContactTwiceEnergy(met, gInDisplacement - outer);
        }
#endif
        before = q;
    }
    gObjective *= 0.5;
    gStartObjective *= 0.5;
}

void eliminate() {
    RodForm form = noForm();
    [loop] for (uint j = SEGMENTS; j-- > FIRST_SEGMENT;) {
        const float4 aimed = target(j);
        float3 r = (predictedDisplacement(j) - aimed.xyz) * aimed.w;
#if HAIR_SPHERES
        if (gReachable != 0u) {
            const RodContact met = contact(j);
            r += met.gradient;
            rodAddContact(form, met.hessian[0], met.hessian[1], met.hessian[2], met.hessian[3], met.hessian[4],
                          met.hessian[5]);
        }
#endif
        float3 pull = r;
        if (!gPredicts) pull = float3(0, 0, 0);
        rodAddNode(form, aimed.w, r, pull);
        const float4 rest = restTangentAndBend(j), q = predictedRotation(j), relative = predictedRelative(j);
        const float bend = rest.w * gDamped;
        RodGains found;
        rodEliminate(form, q, rodRotate(q, rest.xyz), segmentLength(j), relative, twice(relative) - wantedStrain(j),
                     bend, section(j, bend), found);
        setGains(j, found);
    }
}

/// Turns the segments from root to tip; returns the objective.
float advance(float share) {
    float3 outer = gInDisplacement, predicted = gInDisplacement;
    float3 x = float3(0, 0, 0), u = float3(0, 0, 0);
    float4 before = gInner;
    float sum = 0.0;
    EACH_SEGMENT(j) {
        const RodGains g = gains(j);
        u -= float3(rodGain(g, 0, share, x, u), rodGain(g, 1, share, x, u), rodGain(g, 2, share, x, u));
        const float4 from = predictedRotation(j), rest = restTangentAndBend(j), q = rodTurned(from, u);
        const float3 change = rodTangentChange(u, rodRotate(from, rest.xyz));
        // Displacements are summed from rotations: differences of positions would lose their digits.
        const float3 here = predictedDisplacement(j);
        outer = mad3(change, segmentLength(j), outer) + (here - predicted);
        predicted = here;
        x = outer - here;
        const float4 relative = rodRelative(before, q, predictedRelative(j)), aimed = target(j);
        const float bend = rest.w * gDamped;
        const float3 off = outer - aimed.xyz;
        sum += rodTwiceEnergy(twice(relative) - wantedStrain(j), bend, section(j, bend)) +
               aimed.w * dot(off, off);
#if HAIR_SPHERES
        if (gReachable != 0u) sum += rodContactTwiceEnergy(contact(j), x);
#endif
        setNewDisplacement(j, outer);
        setNewRelative(j, relative);
        setRotation(j, q);
        setIncrement(j, predictedIncrement(j) + u);
        before = q;
    }
    return sum * 0.5;
}

/// One step of Gauss-Newton from the guess.
void descend() {
    eliminate();
    float share = 1.0;
    const float limit = gObjective + mad(gObjective, 1e-5, roundingOf(gObjective));
    [loop] for (uint shortenings = 0; shortenings <= HAIRLOOM_ROD_SHORTENINGS + 1; ++shortenings) {
        const float objective = advance(share);
        // What is no number has risen, too.
        if (objective <= limit && isSound(float3(objective, limit, 0.0))) break;
        share = shortenings < HAIRLOOM_ROD_SHORTENINGS ? share * HAIRLOOM_ROD_SHORTENING : 0.0;
    }
}

#if HAIR_SPHERES
/// Looks for contacts where the step has led. Where it has pressed a node into a shape that the prediction had outside,
/// or holds one that it has lifted off, what it has found is the next guess; false: nowhere. Looks after the first are
/// for hair that comes to rest (models/rods/rod_look-inl.h).
bool lookAgain(bool isFirst) {
    if (!gNear) return false;
    bool wrong = false;
    const float deepest = isFirst ? 1e9 : HAIRLOOM_ROD_CONTACT_SUNK;
    float farthest = 0.0;
    float3 position = firstPosition();
    EACH_SEGMENT(j) {
        const float3 tangent = rodRotate(rotation(j), restTangent(j));
        position = mad3(tangent, segmentLength(j), position);
        if (isNear(j)) {
            const RodNode node = nodeOf(j + 1, newDisplacement(j), tangent, position, target(j).w);
            const RodContact met = contact(j);
            const bool held = met.touching > 0.0;
            const float slack = rodSlackOf(met, newDisplacement(j) - predictedDisplacement(j));
            bool inside = false, lifted = held && slack == 0.0;
            EACH_SPHERE(k) {
                RodTouch touch;
                if (touchSphere(k, rootAtEnd(), node, touch)) {
                    inside = inside || touch.depth > (held ? deepest : HAIRLOOM_ROD_CONTACT_LOOK);
                    lifted = lifted && !rodHolds(touch, HAIRLOOM_ROD_CONTACT_LOOK);
                }
            }
            wrong = wrong || lifted || inside;
            farthest = max(farthest, dot(node.displacement, node.displacement));
        }
    }
    const float slow = HAIRLOOM_ROD_CONTACT_SLOW * gFrame.h;
    const bool moves = gTouched > 2.0 || farthest > slow * slow;
    if (!wrong || (!isFirst && moves)) return false;
    position = firstPosition();
    gObjective = gTouched = 0.0;
    EACH_SEGMENT(i) {
        const float4 q = rotation(i), rest = restTangentAndBend(i), relative = newRelative(i), aimed = target(i);
        const float3 tangent = rodRotate(q, rest.xyz), moved = newDisplacement(i), off = moved - aimed.xyz;
        position = mad3(tangent, segmentLength(i), position);
        if (isNear(i)) {
            const RodNode node = nodeOf(i + 1, moved, tangent, position, aimed.w);
            const float slack = rodSlackOf(contact(i), moved - predictedDisplacement(i));
            RodContact found = noContact();
            EACH_SPHERE(k) {
                RodTouch touch;
                if (touchSphere(k, rootAtEnd(), node, touch)) press(touch, rodHolds(touch, slack), node, found);
            }
            setContact(i, found);
        }
        const RodContact met = contact(i);
        gTouched = max(gTouched, met.touching);
        const float bend = rest.w * gDamped;
        gObjective += met.twiceEnergy + aimed.w * dot(off, off) +
                      rodTwiceEnergy(twice(relative) - wantedStrain(i), bend, section(i, bend));
        setPredictedRotation(i, q);
        setPredictedRelative(i, relative);
        setPredictedDisplacement(i, moved);
        setPredictedIncrement(i, increment(i));
    }
    gObjective *= 0.5;
    return true;
}
#endif

#include "rod_finish.hlsli"

/// All that moves a rod in a substep, in one solve.
void stageRod() {
    openRodStep();
    bool worse = false;
    [loop] for (uint attempt = 0; attempt < 2; ++attempt) {
        gPredicts = attempt == 0;
        predict();
        worse = gObjective > mad(gStartObjective, HAIRLOOM_ROD_PREDICTION_SHARE, roundingOf(gStartObjective));
        if (!worse) break;
    }
    descend();
#if HAIR_SPHERES
    [loop] for (int look = 0; look < HAIRLOOM_ROD_CONTACT_LOOKS; ++look) {
        if (gReachable == 0u || !lookAgain(look == 0)) break;
        descend();
    }
#endif
    finishRodStep();
}
