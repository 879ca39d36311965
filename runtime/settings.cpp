// SPDX-License-Identifier: MIT
#include "runtime/settings.h"

#include <cassert>
#include <cmath>
#include <sstream>
#include <string_view>

namespace hairloom::runtime {
namespace {

using S = SimulationSettings;

constexpr const char* kIntegrators[] = {"verlet"};
constexpr double kLargestCount = 4294967295.0;

constexpr FieldInfo kFields[] = {
    {"integrator", "", 0, 0, "how motion is advanced", &S::integrator, kIntegrators},
    {"substeps", "", 1, 64, "steps per frame: more is stiffer, more exact and slower", &S::substeps, {}},
    {"dampingTime",
     "s",
     0,
     100,
     "time in which motion falls to 1/e: lower is calmer, 0 is undamped",
     &S::dampingTime,
     {}},
    {"teleportDistance",
     "m",
     0.01,
     10000,
     "a root that moves farther in a frame carries its strand along",
     &S::teleportDistance,
     {}},
    {"clampedPoints",
     "",
     1,
     2,
     "points held by the scalp: 1 is a hinge, 2 keeps the authored direction",
     &S::clampedPoints,
     {}},
    {"lengthIterations",
     "",
     0,
     16,
     "corrections of segment lengths per substep: 0 lets hair stretch freely",
     &S::lengthIterations,
     {}},
    {"maximalExtension",
     "",
     0,
     0.48,
     "share of its length by which a segment may ever be longer",
     &S::maximalExtension,
     {}},
    {"angularStiffness",
     "",
     0,
     1,
     "how strongly hair returns to its shape: 0 is off, 1 is rigid",
     &S::angularStiffness,
     {}},
    {"angularTipShare",
     "",
     0,
     1,
     "stiffness at the tip as a share of that at the root: lower is looser",
     &S::angularTipShare,
     {}},
    {"gravity", "m/s²", -1000, 1000, "acceleration of everything", &S::gravity, {}},
    {"airDrag",
     "1/s",
     0,
     1000,
     "rate at which hair takes on the speed of the air: 0 feels no wind",
     &S::airDrag,
     {}},
    {"windDirection", "", -1, 1, "direction in which the wind blows", &S::windDirection, {}},
    {"windSpeed", "m/s", 0, 200, "mean speed of the wind: 0 is still air", &S::windSpeed, {}},
    {"windGustiness", "", 0, 1, "strength of gusts as a share of the speed", &S::windGustiness, {}},
    {"windFrequency", "Hz", 0, 20, "how often gusts change", &S::windFrequency, {}},
    {"windGustSize",
     "m",
     0.01,
     100,
     "distance over which gusts differ: lower separates locks",
     &S::windGustSize,
     {}},
    {"windSeed", "", 0, kLargestCount, "another seed gives another sequence of gusts", &S::windSeed, {}},
    {"pearlRadiusRoot", "m", 0, 0.1, "distance kept from spheres at the root", &S::pearlRadiusRoot, {}},
    {"pearlRadiusTip", "m", 0, 0.1, "distance kept from spheres at the tip", &S::pearlRadiusTip, {}},
    {"friction", "", 0, 1, "grip of the skin: 0 slides freely, 1 sticks", &S::friction, {}},
    {"restitution", "", 0, 1, "share of the approaching speed kept when bouncing off", &S::restitution, {}},
};

float* componentOf(Float3& v, std::uint32_t component) {
    return component == 0 ? &v.x : component == 1 ? &v.y : &v.z;
}

bool inRange(const FieldInfo& field, double value) {
    if (!(value >= field.min && value <= field.max)) return false;
    const bool whole = std::holds_alternative<std::uint32_t S::*>(field.member) ||
                       std::holds_alternative<Integrator S::*>(field.member);
    return !whole || value == std::floor(value);
}

/// A float holds 0.48 a little above or below the double: the border itself counts as inside.
bool storedInRange(const FieldInfo& field, double value) {
    return value >= static_cast<double>(static_cast<float>(field.min)) &&
           value <= std::max(field.max, static_cast<double>(static_cast<float>(field.max)));
}

}  // namespace

std::span<const FieldInfo> fields() {
    return kFields;
}

const FieldInfo* findField(std::string_view name) {
    for (const FieldInfo& field : kFields) {
        if (name == field.name) return &field;
    }
    return nullptr;
}

std::uint32_t componentCount(const FieldInfo& field) {
    return std::holds_alternative<Float3 S::*>(field.member) ? 3 : 1;
}

double fieldValue(const S& settings, const FieldInfo& field, std::uint32_t component) {
    assert(component < componentCount(field));
    if (const auto* f = std::get_if<float S::*>(&field.member)) return static_cast<double>(settings.*(*f));
    if (const auto* u = std::get_if<std::uint32_t S::*>(&field.member)) return settings.*(*u);
    if (const auto* e = std::get_if<Integrator S::*>(&field.member)) {
        return static_cast<double>(settings.*(*e));
    }
    Float3 vector = settings.*std::get<Float3 S::*>(field.member);
    return static_cast<double>(*componentOf(vector, component));
}

double defaultValue(const FieldInfo& field, std::uint32_t component) {
    return fieldValue(S{}, field, component);
}

bool setFieldValue(S& settings, const FieldInfo& field, double value, std::uint32_t component) {
    assert(component < componentCount(field));
    if (!inRange(field, value)) return false;
    if (const auto* f = std::get_if<float S::*>(&field.member)) {
        settings.*(*f) = static_cast<float>(value);
    } else if (const auto* u = std::get_if<std::uint32_t S::*>(&field.member)) {
        settings.*(*u) = static_cast<std::uint32_t>(value);
    } else if (const auto* e = std::get_if<Integrator S::*>(&field.member)) {
        settings.*(*e) = static_cast<Integrator>(static_cast<std::uint32_t>(value));
    } else {
        *componentOf(settings.*std::get<Float3 S::*>(field.member), component) = static_cast<float>(value);
    }
    return true;
}

std::vector<FieldProblem> validate(const S& settings) {
    std::vector<FieldProblem> problems;
    for (const FieldInfo& field : kFields) {
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
