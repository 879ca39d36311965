// SPDX-License-Identifier: MIT
// The plan in words.
#include <iomanip>
#include <sstream>

#include "hairloom/plan.h"

namespace hairloom::runtime {
namespace {

/// The decided number with what it counts: "9.81 m/s²", "stiffness 0.3".
std::string quantity(Effect effect, float value) {
    std::ostringstream text;
    text << std::setprecision(4);
    switch (effect) {
        case Effect::damping:
            text << "to 1/e in " << value << " s";
            break;
        case Effect::gravity:
            text << value << " m/s²";
            break;
        case Effect::drag:
            text << value << " per second";
            break;
        case Effect::wind:
            text << value << " m/s";
            break;
        case Effect::angular:
            text << "stiffness " << value;
            break;
        case Effect::length:
            text << value << (value == 1.0f ? " iteration" : " iterations");
            break;
        case Effect::collisionRadius:
            text << "up to " << value << " mm";
            break;
        case Effect::torsion:
        case Effect::collision:
        case Effect::continuousCollision:
        case Effect::sleep:
            break;
    }
    return text.str();
}

std::string words(Effect effect, const Decision& decision) {
    std::ostringstream text;
    switch (decision.reason) {
        case Reason::authored:
            return quantity(effect, decision.value);
        case Reason::zeroTime:
            return "zero time";
        case Reason::nothingToMove:
            return "no point of any strand is free";
        case Reason::zeroGravity:
            return "zero gravity";
        case Reason::noAirDrag:
            return "air drag is zero, so hair does not feel air";
        case Reason::windTakesOver:
            return "part of the wind";
        case Reason::zeroSpeed:
            return "zero speed";
        case Reason::noDirection:
            return "no direction";
        case Reason::zeroStiffness:
            return "zero stiffness";
        case Reason::zeroIterations:
            return "zero iterations";
        case Reason::noSpheres:
            return "no spheres";
        case Reason::noneInReach:
            return "no sphere within reach of a strand";
        case Reason::inReach:
            text << decision.value << (decision.value == 1.0f ? " sphere" : " spheres") << " within reach";
            return text.str();
        case Reason::springsOn:
            text << "coil springs of " << decision.value << " Hz";
            return text.str();
        case Reason::noAngular:
            return "no angular springs";
        case Reason::noFrames:
            return "flexion springs need no frames";
        case Reason::straightHair:
            return "hair is straight";
        case Reason::curvedHair:
            return "hair is curved or carries its weight";
        case Reason::byRods:
            return "rods have no other length";
        case Reason::noCollision:
            return "no collision";
        case Reason::zeroRadius:
            return "zero radius";
        case Reason::slowEnough:
            return "nothing moves by a quarter of a sphere's radius in a substep";
        case Reason::fast:
            text << "up to " << 1000.0f * decision.value << " mm in a substep";
            return text.str();
        case Reason::speedUnknown:
            return "speeds are not known beforehand";
        case Reason::byForce:
            return "penalty forces act on what is inside";
        case Reason::neverAsleep:
            return "zero sleep speed";
        case Reason::allAwake:
            return "all strands move";
        case Reason::someAsleep:
            text << decision.value << (decision.value == 1.0f ? " strand" : " strands") << " at rest";
            return text.str();
        case Reason::allAsleep:
            text << "all strands at rest since " << decision.value << " s";
            return text.str();
    }
    return {};
}

struct StageWords {
    const char* name;
    const char* family;
    std::optional<Effect> effect;
};

/// By StageId; families are the rows of the thesis' Table 3.
constexpr StageWords kStages[kStageCount] = {
    {"roots", "animation", std::nullopt},
    {"rod", "integration", std::nullopt},
    {"damping", "integration", Effect::damping},
    {"drag", "external forces", Effect::drag},
    {"wind", "external forces", Effect::wind},
    {"gravity", "external forces", Effect::gravity},
    {"springs", "linear forces", Effect::length},
    {"angularSmallAngle", "angular forces", Effect::angular},
    {"angularExact", "angular forces", Effect::angular},
    {"straightSmallAngle", "angular forces", Effect::angular},
    {"straightExact", "angular forces", Effect::angular},
    {"flexion", "angular forces", Effect::angular},
    {"penalty", "collision", Effect::collision},
    {"verlet", "integration", std::nullopt},
    {"open", "integration", std::nullopt},
    {"openHalfway", "integration", std::nullopt},
    {"explicitEuler", "integration", std::nullopt},
    {"leapfrog", "integration", std::nullopt},
    {"verletDrift", "integration", std::nullopt},
    {"verletEvaluationState", "integration", std::nullopt},
    {"verletKick", "integration", std::nullopt},
    {"rungeKutta1", "integration", std::nullopt},
    {"rungeKutta2", "integration", std::nullopt},
    {"rungeKutta3", "integration", std::nullopt},
    {"rungeKutta4", "integration", std::nullopt},
    {"implicitFree", "integration", std::nullopt},
    {"implicitBend", "integration", std::nullopt},
    {"implicitSpring", "integration", std::nullopt},
    {"implicitSpringBend", "integration", std::nullopt},
    {"angular", "angular forces", Effect::angular},
    {"angularStraight", "angular forces", Effect::angular},
    {"length", "linear forces", Effect::length},
    {"lengthNow", "linear forces", Effect::length},
    {"springLimit", "post-processing", Effect::length},
    {"collision", "collision", Effect::collision},
    {"collisionBack", "collision", Effect::collision},
    {"continuousCollision", "collision", Effect::continuousCollision},
    {"extension", "post-processing", Effect::length},
    {"lengthRate", "linear forces", Effect::length},
};

}  // namespace

const char* effectName(Effect effect) {
    constexpr const char* kNames[kEffectCount] = {"damping",
                                                  "gravity",
                                                  "drag",
                                                  "wind",
                                                  "length",
                                                  "angular",
                                                  "torsion",
                                                  "collision",
                                                  "collisionRadius",
                                                  "continuousCollision",
                                                  "sleep"};
    return kNames[static_cast<std::size_t>(effect)];
}

const char* stageName(StageId stage) {
    return kStages[static_cast<std::size_t>(stage)].name;
}

const char* stageFamily(StageId stage) {
    return kStages[static_cast<std::size_t>(stage)].family;
}

std::optional<Effect> stageEffect(StageId stage) {
    return kStages[static_cast<std::size_t>(stage)].effect;
}

std::string EffectPlan::why(Effect effect) const {
    const Decision& decision = decisions_[static_cast<std::size_t>(effect)];
    return std::string(effectName(effect)) + (decision.on ? ": on, " : ": off, ") + words(effect, decision);
}

}  // namespace hairloom::runtime
