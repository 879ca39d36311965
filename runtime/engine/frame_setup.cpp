// SPDX-License-Identifier: MIT
#include "engine/frame_setup.h"

#include <algorithm>
#include <cmath>

#include "engine/checks.h"
#include "engine/strand_model.h"
#include "hairloom/capsules.h"

namespace hairloom::runtime {
namespace {

/// Faster air is a mistake, and its squares would leave the range of single precision.
bool isWind(Float3 velocity) {
    constexpr float kMax = 1000.0f;  // m/s
    return isFinite(velocity) && length(velocity) <= kMax;
}

/// Around two spheres and all that lies between them.
Sphere sphereAround(const Sphere& first, const Sphere& second) {
    const float half = 0.5f * length(second.center_ws - first.center_ws);
    return {(first.center_ws + second.center_ws) * 0.5f, half + std::max(first.radius, second.radius)};
}

bool joinSame(const Capsule& a, const Capsule& b) {
    return (a.first == b.first && a.second == b.second) || (a.first == b.second && a.second == b.first);
}
bool contains(std::span<const Capsule> capsules, const Capsule& one) {
    return std::any_of(capsules.begin(), capsules.end(), [&](const Capsule& c) { return joinSame(c, one); });
}

void findWaking(float hair, const FormerSpheres& before, FrameSpheres& spheres) {
    const std::size_t count = std::max(spheres.given, before.spheres.size());
    spheres.waking.clear();
    spheres.waking.reserve(2 * (count + std::max(before.capsules.size(), spheres.capsules.size())));
    const auto thenOf = [&](std::size_t i) {
        return i < before.spheres.size() ? before.spheres[i] : Sphere{};
    };
    const auto nowOf = [&](std::size_t i) { return i < spheres.given ? spheres.usable[i] : Sphere{}; };
    const auto changed = [&](std::size_t i) {
        const Sphere then = thenOf(i), now = nowOf(i);
        return !(then.center_ws == now.center_ws && then.radius == now.radius);
    };
    const auto movedBy = [&](std::size_t i) {
        const Sphere then = thenOf(i), now = nowOf(i);
        const bool moved = then.radius > 0.0f && now.radius > 0.0f;
        return moved ? length(now.center_ws - then.center_ws) : 0.0f;
    };
    const auto wakes = [&](const Sphere& sphere, float distance) {
        if (sphere.radius > 0.0f)
            spheres.waking.push_back({sphere.center_ws, hair + sphere.radius + distance});
    };
    for (std::size_t i = 0; i < count; ++i) {
        if (!changed(i)) continue;
        wakes(thenOf(i), movedBy(i));
        wakes(nowOf(i), movedBy(i));
    }
    const auto wakesAlong = [&](std::span<const Capsule> capsules, std::span<const Capsule> others,
                                const auto& sphereOf) {
        for (const Capsule& capsule : capsules) {
            if (contains(others, capsule) && !changed(capsule.first) && !changed(capsule.second)) continue;
            wakes(sphereAround(sphereOf(capsule.first), sphereOf(capsule.second)),
                  std::max(movedBy(capsule.first), movedBy(capsule.second)));
        }
    };
    wakesAlong(before.capsules, spheres.capsules, thenOf);
    wakesAlong(spheres.capsules, before.capsules, nowOf);
}

MovingSphere movingOf(const FrameSpheres& spheres, std::size_t i, float share) {
    const Sphere& sphere = spheres.usable[i];
    return {sphere.center_ws - spheres.motion[i], spheres.motion[i] * share, sphere.radius};
}

/// Its ends go evenly, so that they are farthest apart at the start or the end of the frame.
MovingCapsule movingOf(const FrameSpheres& spheres, const Capsule& capsule, std::uint32_t substeps) {
    const float share = 1.0f / static_cast<float>(substeps);
    MovingCapsule moving{{movingOf(spheres, capsule.first, share), movingOf(spheres, capsule.second, share)},
                         {}};
    const auto& [first, second] = moving.ends;
    const auto widest = std::max(first.radius, second.radius);
    const float apart =
        std::max(length(second.from_ws - first.from_ws),
                 length(spheres.usable[capsule.second].center_ws - spheres.usable[capsule.first].center_ws));
    moving.around = {(first.from_ws + second.from_ws) * 0.5f, (first.step + second.step) * 0.5f,
                     0.5f * apart + widest, std::max(first.stepLength, second.stepLength)};
    // Nothing comes near it.
    if (spheres.ofSkin[capsule.first] != 0 && spheres.ofSkin[capsule.second] != 0)
        moving.around.radius = -kFarthest;
    return moving;
}

/// Whether lengths between such spheres stay within single precision.
bool isWithin(const Sphere& sphere) {
    return length(sphere.center_ws) < kFarthest && sphere.radius < kFarthest;
}

/// Capsules between usable spheres, and spheres along them.
void takeCapsules(std::span<const Capsule> capsules, FrameSpheres& spheres) {
    spheres.capsules.clear();
    spheres.ends.assign(spheres.given, 0);
    capsules = capsules.first(std::min(capsules.size(), kMaxCapsules));
    // However long they get: the next frame asks for no memory.
    reserveSpheres(spheres.given, capsules.size(), spheres);
    for (const Capsule& capsule : capsules) {
        const std::span<const Sphere> usable = std::span<const Sphere>(spheres.usable).first(spheres.given);
        if (!isCapsule(capsule, usable) || contains(spheres.capsules, capsule) ||
            !isWithin(usable[capsule.first]) || !isWithin(usable[capsule.second]))
            continue;
        spheres.capsules.push_back(capsule);
        spheres.ends[capsule.first] = spheres.ends[capsule.second] = 1;
        const Sphere first = spheres.usable[capsule.first], second = spheres.usable[capsule.second];
        const Float3 motion = spheres.motion[capsule.first], other = spheres.motion[capsule.second];
        forEachAlongCapsule(first, second, [&](const Sphere& sphere, float share) {
            spheres.usable.push_back(sphere);
            spheres.motion.push_back(motion + (other - motion) * share);
        });
    }
    spheres.planned.assign(spheres.usable.begin(), spheres.usable.end());
    spheres.plannedMotion.assign(spheres.motion.begin(), spheres.motion.end());
    for (const Capsule& capsule : spheres.capsules) {
        const Sphere first = spheres.usable[capsule.first], second = spheres.usable[capsule.second];
        const Float3 motion = spheres.motion[capsule.first], other = spheres.motion[capsule.second];
        Sphere around = sphereAround(first, second);
        around.radius += 0.5f * length(other - motion);
        spheres.planned.push_back(around);
        spheres.plannedMotion.push_back((motion + other) * 0.5f);
    }
}

/// SubstepContext::slowestSwept for the spheres and collision radii of the context.
float slowestSwept(const SubstepContext& context) {
    float smallest = 1e30f, fastestSquared = 0.0f;
    for (const MovingSphere& sphere : context.spheres) {
        smallest = std::min(smallest, sphere.radius);
        fastestSquared = std::max(fastestSquared, dot(sphere.step, sphere.step));
    }
    smallest += std::min(context.collisionRadiusAtRoot, context.collisionRadiusAtTip);
    return std::max(0.999f * kUnsweptShare * smallest - 1.001f * std::sqrt(fastestSquared), 0.0f);
}

}  // namespace

void reserveSpheres(std::size_t given, std::size_t capsules, FrameSpheres& spheres) {
    const std::size_t along = given + kMaxAlongCapsule * capsules;
    spheres.usable.reserve(along);
    spheres.motion.reserve(along);
    spheres.planned.reserve(along + capsules);
    spheres.plannedMotion.reserve(along + capsules);
    spheres.capsules.reserve(capsules);
    spheres.ends.reserve(given);
    spheres.ofSkin.reserve(given);
    spheres.waking.reserve(2 * (given + capsules));
}

void takeSpheres(const SimulationSettings& settings, float longestStrand, const FormerSpheres& before,
                 std::span<const Sphere> given, std::span<const Capsule> capsules, FrameSpheres& spheres) {
    spheres.usable.assign(given.begin(), given.end());
    spheres.given = given.size();
    spheres.motion.assign(given.size(), Float3{});
    spheres.ofSkin.assign(given.size(), 0);
    spheres.rejected = 0;
    for (std::size_t i = 0; i < given.size(); ++i) {
        Sphere& sphere = spheres.usable[i];
        if (!isFinite(sphere.center_ws) || !std::isfinite(sphere.radius) || !(sphere.radius > 0.0f)) {
            sphere = {};
            ++spheres.rejected;
            continue;
        }
        if (!before.isCut && i < before.spheres.size() && before.spheres[i].radius > 0.0f) {
            const Float3 motion = sphere.center_ws - before.spheres[i].center_ws;
            if (length(motion) <= settings.teleportDistance) spheres.motion[i] = motion;
        }
    }
    takeCapsules(capsules, spheres);
    findWaking(hairReach(settings, longestStrand), before, spheres);
}

void moveSpheres(const FrameSpheres& spheres, std::uint32_t substeps, Vector<MovingSphere>& moving) {
    moving.clear();
    moving.reserve(spheres.given + kMaxAlongCapsule * spheres.capsules.size());
    const float share = 1.0f / static_cast<float>(substeps);
    for (std::size_t i = 0; i < spheres.usable.size(); ++i) {
        if (spheres.usable[i].radius > 0.0f) moving.push_back(movingOf(spheres, i, share));
    }
}

std::size_t moveCapsules(const FrameSpheres& spheres, std::uint32_t substeps, Vector<MovingSphere>& moving,
                         Vector<MovingCapsule>& capsules) {
    moving.clear();
    capsules.clear();
    moving.reserve(spheres.given);
    capsules.reserve(spheres.capsules.size());
    const float share = 1.0f / static_cast<float>(substeps);
    const auto move = [&](bool ofSkin) {
        for (std::size_t i = 0; i < spheres.given; ++i) {
            if (spheres.usable[i].radius > 0.0f && spheres.ends[i] == 0 && (spheres.ofSkin[i] != 0) == ofSkin)
                moving.push_back(movingOf(spheres, i, share));
        }
        return moving.size();
    };
    const std::size_t pressing = move(false);
    move(true);
    for (const Capsule& capsule : spheres.capsules) capsules.push_back(movingOf(spheres, capsule, substeps));
    return pressing;
}

std::uint32_t takeWind(const SimulationSettings& settings, const FrameInput& input, FrameWind& wind) {
    WindInput given;
    std::uint32_t rejected = 0;
    if (input.wind_ws) {
        if (isWind(*input.wind_ws)) {
            given.mean_ws = input.wind_ws;
        } else {
            ++rejected;
        }
    }
    if (isWind(input.actorVelocity_ws)) {
        given.actorVelocity_ws = input.actorVelocity_ws;
    } else {
        ++rejected;
    }
    const bool before = wind.given;
    wind.given =
        given.mean_ws || (settings.windKind == WindKind::vehicle && given.actorVelocity_ws != Float3{});
    if (wind.given || before) wind.wind = makeWind(settings, given);
    return rejected;
}

EffectPlan planFrame(const SimulationSettings& settings, const FramePlanInput& planInput,
                     const FrameWind& wind, std::span<const Sphere> spheres,
                     std::span<const Float3> sphereMotion, float frameTime) {
    PlanInput scene;
    scene.settings = settings;
    scene.strandCount = planInput.strandCount;
    scene.longestPointCount = planInput.longestPointCount;
    scene.longestStrand = planInput.longestStrand;
    scene.straight = planInput.straight;
    scene.rootsMin_ws = planInput.rootsMin_ws;
    scene.rootsMax_ws = planInput.rootsMax_ws;
    scene.spheres = spheres;
    scene.sphereMotion = sphereMotion;
    SimulationSettings& planned = scene.settings;
    if (wind.given) {
        planned.windSpeed = length(wind.wind.mean);
        if (planned.windSpeed > 0.0f) planned.windDirection = wind.wind.mean * (1.0f / planned.windSpeed);
    }
    float sphereDisplacement = 0.0f;
    for (const Float3& motion : sphereMotion)
        sphereDisplacement = std::max(sphereDisplacement, length(motion));
    // Within a frame hair may gain what gravity and air give, and a whip of its own.
    const auto substeps = static_cast<float>(substepsIn(settings, frameTime));
    const float h = frameTime / substeps;
    const float pushed = (length(settings.gravity) + settings.airDrag * length(wind.wind.mean)) * frameTime;
    scene.fastest =
        16.0f * planInput.fastest * h + pushed * h + (planInput.rootMotion + sphereDisplacement) / substeps;
    scene.asleep = planInput.asleep;
    scene.restTime = planInput.restTime;
    scene.hairCell = planInput.hairCell;
    scene.poses = static_cast<std::uint32_t>(planInput.poseAmounts.size());
    for (const float amount : planInput.poseAmounts) scene.poseAmount = std::max(scene.poseAmount, amount);
    // Of strands whose amount rises, too, which were slow before.
    if (scene.poseAmount > 0.0f) scene.fastest += 2.0f * kPoseSpeed * h;
    return plan(scene);
}

Float3 shiftOfOrigin(const std::array<double, 3>& from_ws, const std::array<double, 3>& to_ws) {
    return {static_cast<float>(from_ws[0] - to_ws[0]), static_cast<float>(from_ws[1] - to_ws[1]),
            static_cast<float>(from_ws[2] - to_ws[2])};
}

SubstepContext substepContext(const SimulationSettings& settings, const EffectPlan& plan, float dt,
                              std::uint32_t substeps, std::span<const MovingSphere> spheres,
                              std::span<const MovingCapsule> capsules) {
    const float h = dt / static_cast<float>(substeps);
    SubstepContext context;
    context.count = substeps;
    context.h = h;
    if (plan.on(Effect::collisionRadius)) {
        context.collisionRadiusAtRoot = settings.collisionRadiusRoot;
        context.collisionRadiusAtTip = settings.collisionRadiusTip;
    }
    context.air = plan.on(Effect::wind) ? Air::moving : plan.on(Effect::drag) ? Air::still : Air::none;
    context.gravity = settings.gravity;
    context.airDrag = settings.airDrag;
    context.gravityStep = settings.gravity * (h * h);
    context.spheresRest = std::all_of(spheres.begin(), spheres.end(),
                                      [](const MovingSphere& sphere) { return sphere.stepLength == 0.0f; }) &&
                          std::all_of(capsules.begin(), capsules.end(), [](const MovingCapsule& capsule) {
                              return capsule.around.stepLength == 0.0f;
                          });
    context.sweeps = plan.on(Effect::continuousCollision);
    context.friction = settings.friction;
    context.restitution = settings.restitution;
    context.spheres = spheres;
    context.shelters = spheres;
    context.capsules = capsules;
    context.windShelter = settings.windShelter;
    context.segmentsTouch = settings.collisionSegments;
    context.slowestSwept = slowestSwept(context);
    modelOf(settings.strandModel).fillNumbers(settings, plan, context);
    return context;
}

}  // namespace hairloom::runtime
