// SPDX-License-Identifier: MIT
// The end of a rod's substep.

/// Takes the share of its motion from a strand.
void slowRod(float share) {
    OWN_SEGMENTS(j) {
        setVelocity(j + 1, velocity(j + 1) * share);
        setIncrement(j, increment(j) * share);
    }
}

/// Takes the step: places, velocities, and what the next one starts from.
void finishRodStep() {
    float3 at = beginOfNow(true);
    float turn = 0.0, energy = 0.0, kinetic = 0.0, size = 0.0, stiffness = 0.0, masses = 0.0;
    // The least that the normal part of a contact's force can be of it.
    const float normalShare = 1.0 / sqrt(1.0 + gFrame.substep.friction * gFrame.substep.friction);
    float touched = 0.0;
#if HAIR_SPHERES
    if (meetsShapes()) touched = gTouched;
#endif
    // A bounce is no smooth motion: speeds behind it are those of the mean way.
    const bool bounces = touched > 2.0;
    const float blend = bounces ? 0.0 : gBlend, inverseStep = bounces ? 1.0 / gFrame.h : gInverseTimeStep;
    OWN_SEGMENTS(j) {
        const uint node = j + 1;
        const float4 rest = restTangentAndBend(j), relative = newRelative(j);
        at = mad3(rodRotate(rotation(j), rest.xyz), segmentLength(j), at);
        const float3 moved = newDisplacement(j);
        float3 now = negMad3(displacement(node), blend, moved) * inverseStep;
#if HAIR_BODY
        // What goes back and forth on skin is as fast as it gets on.
        if (touched > 0.0 && gFrame.substep.restitution <= 0.0 && goesBack(moved, displacement(node)))
            now = (moved + displacement(node)) * (0.5 / gFrame.h);
#endif
        setVelocityBefore(node, velocity(node));
        setVelocity(node, now);
        setDisplacement(node, moved);
        setPosition(node, at);
        setPrevious(node, at - moved);
        // Strains are those of quaternions with w ≥ 0; the one before goes with the new one.
        const float3 bent = withSignOf(twice(relative), relative.w);
        setStrainBefore(j, withSignOf(strain(j), relative.w));
        setStrain(j, bent);
        const float3 turned = increment(j);
        turn = max(turn, dot(turned, turned));
        stiffness += rest.w;
        const float metres = mass(node);
#if HAIR_POSES
        const float4 drawn = poseOf(node);
        float elastic = rodTwiceEnergy(bent - poseStrain(j), rest.w, section(j, rest.w)) * 0.5;
        elastic = mad(rodPoseTwiceEnergy(metres, drawn.w, rodRotate(gInner, drawn.xyz) - at), 0.5, elastic);
#else
        const float elastic = rodTwiceEnergy(bent, rest.w, section(j, rest.w)) * 0.5;
#endif
        const float weight = metres * dot(gRod.gravity.xyz, at);
        energy += elastic - weight;
        size += elastic + abs(weight);
        kinetic = mad(metres * 0.5, dot(now, now), kinetic);
        masses += metres;
        float pressed = 0.0;
#if HAIR_SPHERES
        if (meetsShapes()) {
            const RodContact met = contact(j);
            const float3 force = rodContactForce(met, moved - predictedDisplacement(j));
            if (dot(force, met.normal) > 0.0) pressed = sqrt(dot(force, force)) * normalShare;
            if (met.touching > 1.0) pressed = -pressed;
        }
#endif
#if HAIR_BODY
        keepFolds(node, moved, pressed != 0.0);
#endif
        setLoad(node, pressed);
    }
    // While nothing moves the root and no air blows, energy cannot rise: what rounding and the time scheme add is taken
    // back.
    const float last = energyBefore();
    float4 sums = float4(energy, kinetic, size, stiffness), largest = float4(turn, 0.0, 0.0, 0.0);
    join(sums, largest);
    float4 weights = float4(masses, 0.0, 0.0, 0.0), none = float4(0, 0, 0, 0);
    join(weights, none);
    energy = sums.x;
    kinetic = sums.y;
    size = sums.z;
    stiffness = sums.w;
    masses = weights.x;
    turn = bounces ? HAIRLOOM_ROD_NO_STEP : sqrt(largest.x);
    float noise = 30.0 * HAIRLOOM_ROD_ROUNDING * (size + kinetic) +
                        4.0 * HAIRLOOM_ROD_ROUNDING * sqrt((size + size) * stiffness);
    // Where spheres press, what is as slow as this is rounding.
    if (touched > 0.0) noise = mad(masses, 0.5 * HAIRLOOM_ROD_CONTACT_SPEED * HAIRLOOM_ROD_CONTACT_SPEED, noise);
    float after = energy + kinetic;
    if (gStill && after > last + noise && kinetic > 0.0) {
        const float share = sqrt(min(max((last - energy) / max(kinetic, 1e-30), 0.0), 1.0));
        slowRod(share);
        after = mad(kinetic, share * share, energy);
        if (share < 0.9) {
            turn = HAIRLOOM_ROD_NO_STEP;
            gGuarded = true;
        }
    }
    // What contacts with spheres that move do is work that is not counted here. Those that rest can only take: what they
    // push out of them comes to rest outside.
    if (touched > 0.0 && gRod.conservative != 2u) after = HAIRLOOM_ROD_NO_ENERGY;
    ALONE {
        setEnergyBefore(after);
        setLargestTurn(turn);
    }
    MEET
}
