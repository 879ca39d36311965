// SPDX-License-Identifier: MIT
#include "hairloom/settings.h"

#include <cassert>
#include <cmath>
#include <sstream>
#include <string_view>
#include <type_traits>

namespace hairloom::runtime {
namespace {

using S = SimulationSettings;

constexpr const char* kIntegrators[] = {"verlet",        "velocityVerlet", "leapfrog",
                                        "explicitEuler", "implicitEuler",  "rk4"};
constexpr const char* kLengthMethods[] = {"constraint", "springs", "springVelocities"};
constexpr const char* kAngularMethods[] = {"implicit", "cheap", "exact", "flexion"};
constexpr const char* kWindKinds[] = {"uniform", "gusting", "turbulent", "vehicle"};
constexpr const char* kResponses[] = {"radial", "backward", "penalty"};
constexpr double kLargestCount = 4294967295.0;

constexpr FieldInfo choiceField(const char* name, const char* meaning, FieldInfo::Member member,
                                std::span<const char* const> choices) {
    return {name, "", 0, static_cast<double>(choices.size() - 1), meaning, member, choices};
}

// clang-format off
constexpr FieldInfo kFields[] = {
    choiceField("integrator", "how motion is advanced", &S::integrator, kIntegrators),
    {"substeps", "", 1, 64, "steps per frame: more is stiffer, more exact and slower", &S::substeps, {}},
    {"dampingTime", "s", 0, 100, "time in which motion falls to 1/e: lower is calmer, 0 is undamped", &S::dampingTime, {}},
    {"teleportDistance", "m", 0.01, 10000, "a root that moves farther in a frame carries its strand along", &S::teleportDistance, {}},
    {"sleepSpeed", "m/s", 0, 1, "slower strands fall asleep: 0 keeps all awake", &S::sleepSpeed, {}},
    {"sleepDelay", "s", 0, 10, "time at rest before a strand falls asleep", &S::sleepDelay, {}},
    {"clampedPoints", "", 1, 2, "points held by the scalp: 1 is sprung, 2 keeps the authored direction", &S::clampedPoints, {}},
    choiceField("lengthMethod", "how segments keep their length", &S::lengthMethod, kLengthMethods),
    {"lengthIterations", "", 0, 16, "corrections of segment lengths per substep: 0 lets hair stretch freely", &S::lengthIterations, {}},
    {"maximalExtension", "", 0, 0.48, "share of its length by which a segment may ever be longer", &S::maximalExtension, {}},
    {"springFrequency", "Hz", 1, 10000, "stiffness of coil springs: higher stretches less and needs shorter steps", &S::springFrequency, {}},
    choiceField("angularMethod", "how strands keep their shape", &S::angularMethod, kAngularMethods),
    {"angularStiffness", "", 0, 1, "how strongly hair returns to its shape: 0 is off, 0.5 real hair, 1 rigid", &S::angularStiffness, {}},
    {"angularCurve", "", 0, 1, "share of the stiffness from root to tip, by keys [place, share]: lower is looser there", &S::angularCurve, {}},
    {"bendDampingTime", "s", 0, 1, "waves faster than this fade: 0 rings on", &S::bendDampingTime, {}},
    {"restGravity", "", 0, 1, "share of gravity that the authored shape already carries: 0 sags from there", &S::restGravity, {}},
    {"gravity", "m/s²", -1000, 1000, "acceleration of everything", &S::gravity, {}},
    {"airDrag", "1/s", 0, 1000, "rate at which hair takes on the speed of the air: 0 feels no wind", &S::airDrag, {}},
    choiceField("windKind", "how the wind varies in space and time", &S::windKind, kWindKinds),
    {"windDirection", "", -1, 1, "direction in which the wind blows, or the vehicle drives", &S::windDirection, {}},
    {"windSpeed", "m/s", 0, 200, "mean speed of the wind: 0 is still air", &S::windSpeed, {}},
    {"windGustiness", "", 0, 1, "strength of gusts as a share of the speed", &S::windGustiness, {}},
    {"windFrequency", "Hz", 0, 20, "how often gusts change", &S::windFrequency, {}},
    {"windGustSize", "m", 0.01, 100, "distance over which gusts differ: lower separates locks", &S::windGustSize, {}},
    {"windSeed", "", 0, kLargestCount, "another seed gives another sequence of gusts", &S::windSeed, {}},
    choiceField("collisionResponse", "how points leave a sphere", &S::collisionResponse, kResponses),
    {"pearlRadiusRoot", "m", 0, 0.1, "distance kept from spheres at the root", &S::pearlRadiusRoot, {}},
    {"pearlRadiusTip", "m", 0, 0.1, "distance kept from spheres at the tip", &S::pearlRadiusTip, {}},
    {"friction", "", 0, 1, "grip of the skin: 0 slides freely, 1 sticks", &S::friction, {}},
    {"restitution", "", 0, 1, "share of the approaching speed kept when bouncing off", &S::restitution, {}},
    {"penaltyFrequency", "Hz", 1, 10000, "stiffness of penalty springs: higher penetrates less and needs shorter steps", &S::penaltyFrequency, {}},
};
// clang-format on

float* componentOf(Float3& v, std::uint32_t component) {
    return component == 0 ? &v.x : component == 1 ? &v.y : &v.z;
}

bool inRange(const FieldInfo& field, double value) {
    if (!(value >= field.min && value <= field.max)) return false;
    const bool whole = std::holds_alternative<std::uint32_t S::*>(field.member) || !field.choices.empty();
    return !whole || value == std::floor(value);
}

/// A float holds 0.48 a little above or below the double: the border itself counts as inside.
bool storedInRange(const FieldInfo& field, double value) {
    return value >= static_cast<double>(static_cast<float>(field.min)) &&
           value <= std::max(field.max, static_cast<double>(static_cast<float>(field.max)));
}

}  // namespace

float greatestStiffness(const S& settings) {
    return settings.angularStiffness * settings.angularCurve.greatest();
}

std::span<const FieldInfo> fields() {
    return kFields;
}

const FieldInfo* findField(std::string_view name) {
    for (const FieldInfo& field : kFields) {
        if (name == field.name) return &field;
    }
    return nullptr;
}

std::vector<std::string> integratorNames() {
    const auto names = findField("integrator")->choices;
    return {names.begin(), names.end()};
}

const char* nameOf(Integrator integrator) {
    return findField("integrator")->choices[static_cast<std::size_t>(integrator)];
}

std::uint32_t componentCount(const FieldInfo& field) {
    if (std::holds_alternative<Ramp S::*>(field.member)) return 0;
    return std::holds_alternative<Float3 S::*>(field.member) ? 3 : 1;
}

double fieldValue(const S& settings, const FieldInfo& field, std::uint32_t component) {
    assert(component < componentCount(field));
    return std::visit(
        [&](auto member) {
            auto value = settings.*member;
            if constexpr (std::is_same_v<decltype(value), Float3>) {
                return static_cast<double>(*componentOf(value, component));
            } else if constexpr (std::is_same_v<decltype(value), Ramp>) {
                return 0.0;
            } else {
                return static_cast<double>(value);
            }
        },
        field.member);
}

double defaultValue(const FieldInfo& field, std::uint32_t component) {
    return fieldValue(S{}, field, component);
}

bool setFieldValue(S& settings, const FieldInfo& field, double value, std::uint32_t component) {
    if (std::holds_alternative<Ramp S::*>(field.member)) return false;
    assert(component < componentCount(field));
    if (!inRange(field, value)) return false;
    std::visit(
        [&](auto member) {
            using Value = std::remove_cvref_t<decltype(settings.*member)>;
            if constexpr (std::is_same_v<Value, Float3>) {
                *componentOf(settings.*member, component) = static_cast<float>(value);
            } else if constexpr (std::is_same_v<Value, Ramp>) {
                return;
            } else if constexpr (std::is_enum_v<Value>) {
                settings.*member = static_cast<Value>(static_cast<std::uint32_t>(value));
            } else {
                settings.*member = static_cast<Value>(value);
            }
        },
        field.member);
    return true;
}

std::vector<FieldProblem> validate(const S& settings) {
    std::vector<FieldProblem> problems;
    for (const FieldInfo& field : kFields) {
        if (const auto* ramp = std::get_if<Ramp S::*>(&field.member)) {
            const std::string problem = problemOf(settings.**ramp);
            if (!problem.empty()) problems.push_back({&field, 0, 0.0, field.name + (' ' + problem)});
        }
        for (std::uint32_t c = 0; c < componentCount(field); ++c) {
            const double value = fieldValue(settings, field, c);
            if (storedInRange(field, value)) continue;
            std::ostringstream text;
            text << field.name;
            if (componentCount(field) == 3) text << '.' << "xyz"[c];
            text << " is " << value << (*field.unit ? " " : "") << field.unit << "; expected " << field.min
                 << " to " << field.max;
            problems.push_back({&field, c, value, text.str()});
        }
    }
    return problems;
}

}  // namespace hairloom::runtime
