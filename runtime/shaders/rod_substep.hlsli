// SPDX-License-Identifier: MIT
// A substep of elastic rods (docs/engine.md, "Rods"): a prediction, one elimination from tip to root, one pass back, and
// the guards that keep the objective from rising. As runtime/models/rods/rod-inl.h.

static float gStepRatio;         // of this substep
static float gBlend;             // c of the time scheme
static float gVelocityAhead;     // share of the last change of velocity that is expected again
static float gTimeStep, gInverseTimeStep;
static float gDamped, gDampingShare;  // 1 + τ/h, and the part of it that is damping
static float3 gInDisplacement;   // of the first free segment's inner node
static float4 gInner;            // rotation of the segment before it
#if HAIR_POSES
static float4 gRootBefore;       // of the root, at the start of the substep
#endif
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
    MEET
    ALONE setRotation(0, gInner);
#endif
#if HAIR_POSES
    gRootBefore = rotationBetween(gRotationFrom, gRotationTo, float(gSubstep) / float(gFrame.substeps));
#endif
    const float4 turned = abs(gRotationFrom - (dot(gRotationFrom, gRotationTo) < 0.0 ? -gRotationTo : gRotationTo));
    const float moved = dot(gRootDisplacement, gRootDisplacement) + turned.x + turned.y + turned.z + turned.w;
    gStill = moved <= 0.0 && gRod.conservative != 0u;
}

/// Where inertia, gravity, air and poses take a node, which the prediction has at `position`, `moved` from where it was; w: its
/// weight m/(h² D).
float4 aim(uint node, float3 tangent, float3 position, float3 moved) {
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
#if HAIR_POSES
    // Moves as the pose does with the root, but for what brings it there.
    const float4 drawn = poseOf(node);
    const float3 pose = rodRotate(gInner, drawn.xyz);
    const float slow = drawn.w + drawn.w;
    rate += slow;
    change = mad3(pose - rodRotate(gRootBefore, drawn.xyz) + gRootDisplacement, slow / gFrame.h * gTimeStep, change);
#endif
    const float slowed = mad(rate, gTimeStep, 1.0);
    float4 aimed = float4(mad3(displacement(node), gBlend, change * (gTimeStep / slowed)),
                          mass(node) * gInverseTimeStep * gInverseTimeStep * slowed);
#if HAIR_POSES
    const float3 way = pose - position;
    const float pull = rodPosePull(mass(node), drawn.w, way), both = aimed.w + pull;
    aimed = float4(mad3(moved + way - aimed.xyz, pull / both, aimed.xyz), both);
#endif
    return aimed;
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
#if HAIR_BODY
    node.fresh = 0.0;
#else
    node.fresh = gFrame.substep.restitution > 0.0 ? 0.0 : 1.0;
#endif
    return node;
}

/// The contacts of segment j's outer node, as predicted.
RodContact meet(uint j, RodNode node) {
    bool near;
    const RodContact found = contactOf(rootAtEnd(), j + 1, node, true, 0.0, near);
    gTouched = max(gTouched, found.touching);
    gNear = gNear || near;
    setNear(j, near);
    setContact(j, found);
    return found;
}
#endif

/// The turn that is expected of segment j.
float3 predictedTurn(uint j) {
    if (!gPredicts) return float3(0, 0, 0);
    const float3 u = increment(j) * gStepRatio;
    const float squared = dot(u, u);
    if (squared > HAIRLOOM_ROD_LARGEST_PREDICTION * HAIRLOOM_ROD_LARGEST_PREDICTION)
        return u * (HAIRLOOM_ROD_LARGEST_PREDICTION / sqrt(squared));
    return u;
}

/// Where the first of this member's segments begins in the guess, and the rotation before it.
void beginOfPrediction(bool runs, out float3 outer, out float3 position, out float4 before) {
    outer = gInDisplacement;
    position = firstPosition();
    before = gInner;
#if HAIR_MEMBERS > 1
    float3 change = float3(0, 0, 0), way = float3(0, 0, 0);
    if (runs) {
        OWN_SEGMENTS(j) {
            const float4 old = rotation(j);
            const float3 u = predictedTurn(j), rest = restTangent(j);
            const float4 q = rodTurned(old, u);
            const float along = segmentLength(j);
            change = mad3(rodTangentChange(u, rodRotate(old, rest)), along, change);
            way = mad3(rodRotate(q, rest), along, way);
            setPredictedRotation(j, q);
        }
    }
    addThoseBefore(change, way, outer, position);
    const uint first = ownFrom(gMember);
    if (first > FIRST_SEGMENT) before = predictedRotation(first - 1);
#endif
}

/// Repeats the last substep's rotations where gPredicts, and finds the objective there and where nothing turns.
void predict(bool runs) {
    float3 outer, position;
    float4 before;
    beginOfPrediction(runs, outer, position, before);
    float2 sums = float2(0, 0);  // the objective, and where nothing turns
    float stiffnesses = 0.0;
#if HAIR_SPHERES
    if (runs) {
        gTouched = 0.0;
        gNear = false;
    }
#endif
    if (runs) OWN_SEGMENTS(j) {
        const float4 old = rotation(j), rest = restTangentAndBend(j);
        const float3 oldTangent = rodRotate(old, rest.xyz), u = predictedTurn(j);
        const float along = segmentLength(j);
        outer = mad3(rodTangentChange(u, oldTangent), along, outer);
        const float4 q = rodTurned(old, u);
        const float3 tangent = rodRotate(q, rest.xyz);
        position = mad3(tangent, along, position);
        const float4 aimed = aim(j + 1, tangent, position, outer);

        // Damping pulls to the strain extrapolated from the last two substeps (Kelvin-Voigt), elasticity to that of a pose, and
        // to none without.
        const float3 last = strain(j);
        float3 wanted = mad3(last - strainBefore(j), gBlend, last) * gDampingShare;
#if HAIR_POSES
        wanted = mad3(poseStrain(j), 1.0 - gDampingShare, wanted);
#endif
        const float4 side = rodOfStrain(last), relative = rodRelative(before, q, side);
        const float bend = rest.w * gDamped;
        const RodSection resists = section(j, bend);
        stiffnesses += bend;
        const float3 off = outer - aimed.xyz, offStart = gInDisplacement - aimed.xyz;
        sums.x += rodTwiceEnergy(twice(relative) - wanted, bend, resists) + aimed.w * dot(off, off);
        float3 strainStart = last;
        if (j == FIRST_SEGMENT) strainStart = twice(rodRelative(gInner, old, side));
        sums.y += rodTwiceEnergy(strainStart - wanted, bend, resists) + aimed.w * dot(offStart, offStart);
        setPredictedRotation(j, q);
        setPredictedRelative(j, relative);
        setWantedStrain(j, wanted);
        setPredictedIncrement(j, u);
        setPredictedDisplacement(j, outer);
        setTarget(j, aimed);
#if HAIR_SPHERES
        if (meetsShapes()) {
#if HAIR_BODY
            findPlane(rootAtEnd(), j + 1, position, outer);
#endif
            const RodContact met = meet(j, nodeOf(j + 1, outer, tangent, position, aimed.w));
            sums.x += met.twiceEnergy;
            sums.y += rodContactTwiceEnergy(met, gInDisplacement - outer);
        }
#endif
        before = q;
    }
    float4 all = float4(sums, stiffnesses, 0.0), most = float4(0, 0, 0, 0);
#if HAIR_SPHERES
    most.xy = float2(gTouched, gNear ? 1.0 : 0.0);
#endif
    join(all, most);
    if (!runs) return;
    gObjective = 0.5 * all.x;
    gStartObjective = 0.5 * all.y;
    gStiffnessSum = all.z;
#if HAIR_SPHERES
    gTouched = most.x;
    gNear = most.y != 0.0;
#endif
}

void eliminate() {
    RodForm form = noForm();
    [loop] for (uint j = SEGMENTS; j-- > FIRST_SEGMENT;) {
        const float4 aimed = target(j);
        float3 r = (predictedDisplacement(j) - aimed.xyz) * aimed.w;
#if HAIR_SPHERES
        if (meetsShapes()) {
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

/// Twice what segment j and its outer node have of the objective where it has turned to q, behind a segment that has turned
/// to `before`, and the node has gone by `outer`; keeps how the vertex is bent then.
float twiceEnergyOf(uint j, float bend, float4 before, float4 q, float3 outer, float3 x) {
    const float4 relative = rodRelative(before, q, predictedRelative(j)), aimed = target(j);
    const float3 off = outer - aimed.xyz;
    float sum = rodTwiceEnergy(twice(relative) - wantedStrain(j), bend, section(j, bend)) + aimed.w * dot(off, off);
#if HAIR_SPHERES
    if (meetsShapes()) sum += rodContactTwiceEnergy(contact(j), x);
#endif
    setNewRelative(j, relative);
    return sum;
}

/// Turns the segments from root to tip; returns the objective.
float advance(float share, bool runs) {
    float3 outer = gInDisplacement, predicted = gInDisplacement;
    float3 x = float3(0, 0, 0), u = float3(0, 0, 0);
    float sum = 0.0;
#if HAIR_MEMBERS > 1
    if (runs && gMember == 0u)
#else
    float4 before = gInner;
#endif
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
        setNewDisplacement(j, outer);
        setRotation(j, q);
        setIncrement(j, predictedIncrement(j) + u);
#if HAIR_MEMBERS == 1
        sum += twiceEnergyOf(j, rest.w * gDamped, before, q, outer, x);
        before = q;
#endif
    }
#if HAIR_MEMBERS > 1
    MEET
    if (runs) OWN_SEGMENTS(i) {
        float4 before = gInner;
        if (i > FIRST_SEGMENT) before = rotation(i - 1);
        const float3 moved = newDisplacement(i);
        sum += twiceEnergyOf(i, restTangentAndBend(i).w * gDamped, before, rotation(i), moved,
                             moved - predictedDisplacement(i));
    }
#endif
    float4 all = float4(sum, 0.0, 0.0, 0.0), none = float4(0, 0, 0, 0);
    join(all, none);
    return 0.5 * all.x;
}

/// One step of Gauss-Newton from the guess.
void descend(bool runs) {
#if HAIR_MEMBERS > 1
    if (runs && gMember == 0u)
#endif
    eliminate();
    float share = 1.0;
    const float limit = gObjective + mad(gObjective, 1e-5, roundingOf(gObjective));
    [loop] for (uint shortenings = 0; shortenings <= HAIRLOOM_ROD_SHORTENINGS + 1; ++shortenings) {
        const float objective = advance(share, runs);
        // What is no number has risen, too.
        runs = runs && !(objective <= limit && isSound(float3(objective, limit, 0.0)));
        if (!anyOf(runs)) break;
        share = shortenings < HAIRLOOM_ROD_SHORTENINGS ? share * HAIRLOOM_ROD_SHORTENING : 0.0;
    }
}

/// Where the first of this member's segments begins, relative to the root, with rotations as they are now.
float3 beginOfNow(bool runs) {
    float3 begin = firstPosition();
#if HAIR_MEMBERS > 1
    float3 way = float3(0, 0, 0), none = float3(0, 0, 0);
    if (runs) OWN_SEGMENTS(j) way = mad3(rodRotate(rotation(j), restTangent(j)), segmentLength(j), way);
    addThoseBefore(way, none, begin, none);
#endif
    return begin;
}

#if HAIR_SPHERES
/// Whether the outer node of segment j is near a shape, or has come to the body since it was last seen.
bool mayTouch(uint j) {
#if HAIR_BODY
    return isNear(j) || mayTouchBody(j + 1, newDisplacement(j));
#else
    return isNear(j);
#endif
}

/// Looks for contacts where the step has led. Where it has pressed a node into a shape that the prediction had outside,
/// or holds one that it has lifted off, what it has found is the next guess; false: nowhere. Looks after the first are
/// for hair that comes to rest; the body has more curves than spheres have: there all are for whatever they find, the last for what
/// is deep (models/rods/rod_look-inl.h).
bool lookAgain(int look, bool runs) {
    const bool isFirst = look == 0;
#if HAIR_BODY
    float any = gNear ? 1.0 : 0.0;
    if (runs) OWN_SEGMENTS(s) any = mayTouchBody(s + 1, newDisplacement(s)) ? 1.0 : any;
    float4 most1 = float4(any, 0.0, 0.0, 0.0), nothing = float4(0, 0, 0, 0);
    join(nothing, most1);
    runs = runs && most1.x != 0.0;
    const bool restsOnly = false, isDeepOnly = look >= HAIRLOOM_ROD_CONTACT_LOOKS;
    const float deepest = HAIRLOOM_BODY_DEEP, inwards = isDeepOnly ? HAIRLOOM_BODY_DEEP : HAIRLOOM_ROD_CONTACT_LOOK;
#else
    runs = runs && gNear;
    const bool restsOnly = !isFirst, isDeepOnly = false;
    const float deepest = isFirst ? 1e9 : HAIRLOOM_ROD_CONTACT_SUNK, inwards = HAIRLOOM_ROD_CONTACT_LOOK;
#endif
    if (!anyOf(runs)) return false;
    const float3 begin = beginOfNow(runs);
    bool wrong = false;
    float farthest = 0.0;
    float3 position = begin;
    if (runs) OWN_SEGMENTS(j) {
        const float3 tangent = rodRotate(rotation(j), restTangent(j));
        position = mad3(tangent, segmentLength(j), position);
        if (mayTouch(j)) {
            const RodNode node = nodeOf(j + 1, newDisplacement(j), tangent, position, target(j).w);
#if HAIR_BODY
            setNear(j, true);
            findPlane(rootAtEnd(), j + 1, position, node.displacement);
#endif
            const RodContact met = contact(j);
            const bool held = met.touching > 0.0;
            const float slack = rodSlackOf(met, newDisplacement(j) - predictedDisplacement(j));
            bool inside = false, lifted = held && slack == 0.0;
            EACH_SHAPE(k) {
                RodTouch touch;
                if (touchShape(k, rootAtEnd(), node, touch)) {
                    inside = inside || touch.depth > (held ? deepest : inwards);
                    lifted = lifted && !rodHolds(touch, HAIRLOOM_ROD_CONTACT_LOOK);
                }
            }
#if HAIR_BODY
            [loop] for (uint which = 0; which < 2u; ++which) {
                RodTouch skin;
                if (touchOfBody(which, j + 1, node, skin)) {
                    inside = inside || skin.depth > (held ? deepest : inwards);
                    lifted = lifted && !rodHolds(skin, HAIRLOOM_ROD_CONTACT_LOOK);
                }
            }
#endif
            wrong = wrong || inside || (lifted && !isDeepOnly);
            farthest = max(farthest, dot(node.displacement, node.displacement));
        }
    }
    float4 seen = float4(wrong ? 1.0 : 0.0, farthest, 0.0, 0.0), none = float4(0, 0, 0, 0);
    join(none, seen);
    const float slow = HAIRLOOM_ROD_CONTACT_SLOW * gFrame.h;
    const bool moves = gTouched > 2.0 || seen.y > slow * slow;
    runs = runs && seen.x != 0.0 && !(restsOnly && moves);
    if (!anyOf(runs)) return false;
    position = begin;
    float sum = 0.0, touched = 0.0;
    if (runs) OWN_SEGMENTS(i) {
        const float4 q = rotation(i), rest = restTangentAndBend(i), relative = newRelative(i), aimed = target(i);
        const float3 tangent = rodRotate(q, rest.xyz), moved = newDisplacement(i), off = moved - aimed.xyz;
        position = mad3(tangent, segmentLength(i), position);
        if (isNear(i)) {
            const RodNode node = nodeOf(i + 1, moved, tangent, position, aimed.w);
            const float slack = rodSlackOf(contact(i), moved - predictedDisplacement(i));
            bool near;
            setContact(i, contactOf(rootAtEnd(), i + 1, node, false, slack, near));
        }
        const RodContact met = contact(i);
        touched = max(touched, met.touching);
        const float bend = rest.w * gDamped;
        sum += met.twiceEnergy + aimed.w * dot(off, off) +
               rodTwiceEnergy(twice(relative) - wantedStrain(i), bend, section(i, bend));
        setPredictedRotation(i, q);
        setPredictedRelative(i, relative);
        setPredictedDisplacement(i, moved);
        setPredictedIncrement(i, increment(i));
    }
    float4 all = float4(sum, 0.0, 0.0, 0.0), most = float4(touched, 0.0, 0.0, 0.0);
    join(all, most);
    if (runs) {
        gObjective = 0.5 * all.x;
        gTouched = most.x;
    }
    return runs;
}
#endif

#include "rod_finish.hlsli"

/// All that moves a rod in a substep, in one solve.
void stageRod() {
    openRodStep();
#if HAIR_BODY
    OWN_SEGMENTS(s) forgetPlane(s + 1);
#endif
    // Drivers inline: each of these is called in one place.
    bool runs = true;
    gPredicts = true;
    [loop] for (uint attempt = 0; attempt < 2; ++attempt) {
        predict(runs);
        runs = runs && gObjective > mad(gStartObjective, HAIRLOOM_ROD_PREDICTION_SHARE, roundingOf(gStartObjective));
        if (!anyOf(runs)) break;
        if (runs) gPredicts = false;
    }
#if HAIR_SPHERES
    runs = true;
#if HAIR_BODY
    const int looks = HAIRLOOM_BODY_LOOKS;
#else
    const int looks = HAIRLOOM_ROD_CONTACT_LOOKS;
#endif
    [loop] for (int look = 0; look <= looks; ++look) {
        descend(runs);
        runs = runs && meetsShapes() && look < looks;
        runs = lookAgain(look, runs);
        if (!anyOf(runs)) break;
    }
#else
    descend(true);
#endif
    finishRodStep();
}
