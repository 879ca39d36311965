// SPDX-License-Identifier: MIT
#include "hairloom/settings.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <sstream>

namespace hairloom::runtime {
namespace {

using S = SimulationSettings;

constexpr const char* kIntegrators[] = {"verlet",        "velocityVerlet", "leapfrog",
                                        "explicitEuler", "implicitEuler",  "rk4"};
constexpr const char* kModels[] = {"rods", "springs"};
constexpr const char* kLengthMethods[] = {"constraint", "springs", "springVelocities"};
constexpr const char* kAngularMethods[] = {"implicit", "smallAngle", "exact", "flexion"};
constexpr const char* kWindKinds[] = {"uniform", "gusting", "turbulent", "vehicle"};
constexpr const char* kResponses[] = {"radial", "backward", "penalty"};
constexpr double kLargestCount = 4294967295.0;

// clang-format off
constexpr Field<S> kFields[] = {
    choiceField<&S::strandModel>("strandModel", "what a strand is: an elastic rod, or masses and springs with the methods below", kModels),
    choiceField<&S::integrator>("integrator", "how springs are advanced; with lengths held verlet, velocityVerlet and rk4 are of order 2, the others of 1", kIntegrators),
    field<&S::substeps>("substeps", "", 1, kMaxSubsteps, "steps in 1/60 s: more is more exact and slower"),
    field<&S::dampingTime>("dampingTime", "s", 0, 100, "time in which motion falls to 1/e: lower is calmer, 0 is undamped"),
    field<&S::teleportDistance>("teleportDistance", "m", 0.01, 10000, "a root that moves farther in a frame carries its strand along"),
    field<&S::sleepSpeed>("sleepSpeed", "m/s", 0, 1, "slower strands fall asleep: 0 keeps all awake"),
    field<&S::sleepDelay>("sleepDelay", "s", 0, 10, "time at rest before a strand falls asleep"),
    field<&S::clampedPoints>("clampedPoints", "", 1, 2, "points held by the scalp: 1 is sprung, 2 keeps the authored direction"),
    choiceField<&S::lengthMethod>("lengthMethod", "how segments keep their length", kLengthMethods),
    field<&S::lengthIterations>("lengthIterations", "", 0, 16, "corrections of segment lengths per substep: 0 lets hair stretch freely"),
    field<&S::maximalExtension>("maximalExtension", "", 0, 0.48, "share of its length by which a segment may ever be longer"),
    field<&S::springFrequency>("springFrequency", "Hz", 1, 10000, "stiffness of coil springs: higher stretches less and needs shorter steps"),
    choiceField<&S::angularMethod>("angularMethod", "how strands keep their shape", kAngularMethods),
    field<&S::angularStiffness>("angularStiffness", "", 0, 1, "how strongly hair returns to its shape: 0 is off, 0.5 real hair, 1 rigid"),
    rampField<&S::angularCurve>("angularCurve", "share of the stiffness from root to tip, by keys [place, share]: lower is looser there"),
    field<&S::torsionRatio>("torsionRatio", "", 0.01, 100, "torsional over bending stiffness of rods: 0.75 is a round fibre"),
    field<&S::sectionRatio>("sectionRatio", "", 0.2, 1, "short over long diameter of the section of rods: 1 is round, 0.6 flat as curly hair"),
    field<&S::bendDampingTime>("bendDampingTime", "s", 0, 1, "waves faster than this fade: 0 rings on"),
    field<&S::restGravity>("restGravity", "", 0, 1, "share of gravity that the authored shape of rods already carries: 0 sags from there"),
    field<&S::gravity>("gravity", "m/s²", -1000, 1000, "acceleration of everything"),
    field<&S::airDrag>("airDrag", "1/s", 0, 1000, "rate at which hair takes on the speed of the air: 0 feels no wind"),
    choiceField<&S::windKind>("windKind", "how the wind varies in space and time", kWindKinds),
    field<&S::windDirection>("windDirection", "", -1, 1, "direction in which the wind blows, or the vehicle drives"),
    field<&S::windSpeed>("windSpeed", "m/s", 0, 200, "mean speed of the wind: 0 is still air"),
    field<&S::windGustiness>("windGustiness", "", 0, 1, "strength of gusts as a share of the speed"),
    field<&S::windFrequency>("windFrequency", "Hz", 0, 20, "how often gusts change"),
    field<&S::windGustSize>("windGustSize", "m", 0.01, 100, "distance over which gusts differ: lower separates locks"),
    field<&S::windSeed>("windSeed", "", 0, kLargestCount, "another seed gives another sequence of gusts"),
    choiceField<&S::collisionResponse>("collisionResponse", "how points leave a sphere", kResponses),
    field<&S::collisionRadiusRoot>("collisionRadiusRoot", "m", 0, 0.1, "distance kept from spheres at the root"),
    field<&S::collisionRadiusTip>("collisionRadiusTip", "m", 0, 0.1, "distance kept from spheres at the tip"),
    field<&S::friction>("friction", "", 0, 1, "grip of the skin: 0 slides freely, 1 sticks"),
    field<&S::restitution>("restitution", "", 0, 1, "share of the approaching speed kept when bouncing off"),
    field<&S::penaltyFrequency>("penaltyFrequency", "Hz", 1, 10000, "stiffness of penalty springs: higher penetrates less and needs shorter steps"),
};
// clang-format on

/// A frame that is longer by this share of a substep, as clocks jitter, needs no other one.
constexpr double kJitter = 0.05;

}  // namespace

std::uint32_t substepsIn(const SimulationSettings& settings, float dt) {
    const double usual = static_cast<double>(dt) / static_cast<double>(kUsualFrame);
    const double count = std::ceil(static_cast<double>(settings.substeps) * usual - kJitter);
    return static_cast<std::uint32_t>(std::clamp(count, 1.0, static_cast<double>(kMaxSubsteps)));
}

float greatestStiffness(const S& settings) {
    return settings.angularStiffness * settings.angularCurve.greatest();
}

std::span<const Field<S>> fieldsOf(const S&) {
    return kFields;
}

std::vector<std::string> integratorNames() {
    return {std::begin(kIntegrators), std::end(kIntegrators)};
}

const char* nameOf(Integrator integrator) {
    return kIntegrators[static_cast<std::size_t>(integrator)];
}

std::vector<std::string> validate(const S& settings) {
    std::vector<std::string> messages;
    for (const FieldProblem& problem : problemsIn(settings)) {
        const FieldInfo& field = *problem.field;
        std::ostringstream text;
        text << problem.where();
        if (problem.ramp.empty()) {
            text << " is " << problem.value << (*field.unit ? " " : "") << field.unit << "; expected "
                 << field.min << " to " << field.max;
        } else {
            text << ' ' << problem.ramp;
        }
        messages.push_back(text.str());
    }
    return messages;
}

}  // namespace hairloom::runtime
