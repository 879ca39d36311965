// SPDX-License-Identifier: MIT
#include "runtime/plan.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace hairloom::runtime {
namespace {

/// Whether the sphere, anywhere on its way, can touch a point that hangs on a root inside the box.
bool withinReach(const Sphere& sphere, Float3 motion, const SceneDescription& scene) {
    if (!(sphere.radius > 0.0f)) return false;
    const SimulationSettings& s = scene.settings;
    const float hair =
        scene.longestStrand * (1.0f + s.maximalExtension) + std::max(s.pearlRadiusRoot, s.pearlRadiusTip);
    const float reach = (hair + sphere.radius) * 1.001f;
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

Decision decideCollision(const SceneDescription& scene) {
    if (scene.spheres.empty()) return {false, Reason::noSpheres, 0.0f};
    // Without the length constraint a strand may reach anywhere.
    std::uint32_t count = 0;
    for (std::size_t i = 0; i < scene.spheres.size(); ++i) {
        const Float3 motion = scene.sphereMotion.empty() ? Float3{} : scene.sphereMotion[i];
        const bool usable = scene.spheres[i].radius > 0.0f;
        if (usable &&
            (scene.settings.lengthIterations == 0 || withinReach(scene.spheres[i], motion, scene))) {
            ++count;
        }
    }
    if (count == 0) return {false, Reason::noneInReach, 0.0f};
    return {true, Reason::inReach, static_cast<float>(count)};
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

const char* quantity(Effect effect) {
    switch (effect) {
        case Effect::gravity:
            return "m/s²";
        case Effect::drag:
            return "per second";
        case Effect::wind:
            return "m/s";
        case Effect::angular:
            return "stiffness";
        case Effect::length:
            return "iterations";
        case Effect::collision:
            return "spheres";
    }
    return "";
}

}  // namespace

const char* effectName(Effect effect) {
    constexpr const char* kNames[kEffectCount] = {"gravity", "drag",   "wind",
                                                  "angular", "length", "collision"};
    return kNames[static_cast<std::size_t>(effect)];
}

const char* stageName(StageId stage) {
    constexpr const char* kNames[kStageCount] = {"roots",   "gravity",   "drag",     "wind",
                                                 "penalty", "integrate", "angular",  "length",
                                                 "sweep",   "collision", "backward", "extension"};
    return kNames[static_cast<std::size_t>(stage)];
}

std::string EffectPlan::why(Effect effect) const {
    const Decision& decision = decisions_[static_cast<std::size_t>(effect)];
    std::ostringstream text;
    text << effectName(effect) << (decision.on ? ": on, " : ": off, ");
    switch (decision.reason) {
        case Reason::authored:
            if (effect == Effect::angular) {
                text << quantity(effect) << ' ' << decision.value;
            } else {
                text << decision.value << ' ' << quantity(effect);
            }
            break;
        case Reason::nothingToMove:
            text << "no point of any strand is free";
            break;
        case Reason::zeroGravity:
            text << "zero gravity";
            break;
        case Reason::noAirDrag:
            text << "air drag is zero, so hair does not feel air";
            break;
        case Reason::windTakesOver:
            text << "part of the wind";
            break;
        case Reason::zeroSpeed:
            text << "zero speed";
            break;
        case Reason::noDirection:
            text << "no direction";
            break;
        case Reason::zeroStiffness:
            text << "zero stiffness";
            break;
        case Reason::zeroIterations:
            text << "zero iterations";
            break;
        case Reason::noSpheres:
            text << "no spheres";
            break;
        case Reason::noneInReach:
            text << "no sphere within reach of a strand";
            break;
        case Reason::inReach:
            text << decision.value << (decision.value == 1.0f ? " sphere" : " spheres") << " within reach";
            break;
    }
    return text.str();
}

EffectPlan plan(const SceneDescription& scene) {
    EffectPlan result;
    const SimulationSettings& s = scene.settings;
    result.add(StageId::roots);
    if (scene.strandCount == 0 || scene.longestPointCount <= s.clampedPoints) return result;

    const auto decide = [&](Effect effect, Decision decision) {
        result.decisions_[static_cast<std::size_t>(effect)] = decision;
        return decision.on;
    };
    const float gravity = length(s.gravity);
    if (decide(Effect::gravity,
               {gravity > 0.0f, gravity > 0.0f ? Reason::authored : Reason::zeroGravity, gravity})) {
        result.add(StageId::gravity);
    }
    const bool wind = decide(Effect::wind, decideWind(s));
    if (decide(Effect::drag, decideDrag(s, wind))) result.add(StageId::drag);
    if (wind) result.add(StageId::wind);
    const bool touches = decide(Effect::collision, decideCollision(scene));
    const bool pushes = s.collisionResponse == CollisionResponse::penalty;
    if (touches && pushes) result.add(StageId::penalty);
    result.add(StageId::integrate);
    const bool stiff = s.angularStiffness > 0.0f;
    if (decide(Effect::angular,
               {stiff, stiff ? Reason::authored : Reason::zeroStiffness, s.angularStiffness})) {
        result.add(StageId::angular);
    }
    const bool held = s.lengthIterations > 0;
    if (decide(Effect::length, {held, held ? Reason::authored : Reason::zeroIterations,
                                static_cast<float>(s.lengthIterations)})) {
        result.add(StageId::length);
    }
    if (touches && !pushes) {
        result.add(StageId::sweep);
        result.add(s.collisionResponse == CollisionResponse::backward ? StageId::backward
                                                                      : StageId::collision);
    }
    if (held) result.add(StageId::extension);
    return result;
}

}  // namespace hairloom::runtime
