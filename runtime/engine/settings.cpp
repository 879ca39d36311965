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
    choiceField<&S::strandModel>("strandModel", "strand model: an elastic rod, or masses and springs with the methods below", kModels),
    choiceField<&S::integrator>("integrator", "time integration of springs. With lengths held, verlet, velocityVerlet and rk4 are of order 2, the others of order 1", kIntegrators),
    field<&S::substeps>("substeps", "", 1, kMaxSubsteps, "time steps per 1/60 s: more are more accurate and slower"),
    field<&S::dampingTime>("dampingTime", "s", 0, 100, "time in which motion decays to 1/e: lower is calmer, 0 is undamped"),
    field<&S::teleportDistance>("teleportDistance", "m", 0.01, 10000, "a root that moves farther than this in a frame carries its strand along (teleport)"),
    field<&S::sleepSpeed>("sleepSpeed", "m/s", 0, 1, "strands slower than this fall asleep: 0 keeps all awake"),
    field<&S::sleepDelay>("sleepDelay", "s", 0, 10, "time at rest before a strand falls asleep"),
    field<&S::clampedPoints>("clampedPoints", "", 1, 2, "points fixed to the scalp: 1 lets the strand hinge with a spring, 2 keeps the authored direction"),
    choiceField<&S::lengthMethod>("lengthMethod", "how segments keep their length", kLengthMethods),
    field<&S::lengthIterations>("lengthIterations", "", 0, 16, "length constraint iterations per substep: 0 lets hair stretch freely"),
    field<&S::maximalExtension>("maximalExtension", "", 0, 0.48, "largest stretch of a segment, as a share of its length"),
    field<&S::springFrequency>("springFrequency", "Hz", 1, 10000, "stiffness of coil springs: higher stretches less and needs shorter time steps"),
    choiceField<&S::angularMethod>("angularMethod", "how strands keep their shape", kAngularMethods),
    field<&S::angularStiffness>("angularStiffness", "", 0, 1, "how strongly hair returns to its shape: 0 is off, 0.5 real hair, 1 rigid"),
    rampField<&S::angularCurve>("angularCurve", "stiffness from root to tip, as keys [place, share]: lower is looser there"),
    field<&S::torsionRatio>("torsionRatio", "", 0.01, 100, "ratio of torsional to bending stiffness of rods: 0.75 is a round fibre"),
    field<&S::sectionRatio>("sectionRatio", "", 0.2, 1, "ratio of the short to the long diameter of the rod's cross-section: 1 is round, 0.6 flat like curly hair"),
    field<&S::bendDampingTime>("bendDampingTime", "s", 0, 1, "bending waves faster than this are damped: 0 is undamped"),
    field<&S::restGravity>("restGravity", "", 0, 1, "share of gravity that the authored shape of rods already carries: 1 keeps the shape, 0 lets it sag"),
    field<&S::gravity>("gravity", "m/s²", -1000, 1000, "gravity, an acceleration"),
    field<&S::airDrag>("airDrag", "1/s", 0, 1000, "rate at which hair takes on the air's velocity: 0 feels no wind"),
    choiceField<&S::windKind>("windKind", "how the wind varies in space and time", kWindKinds),
    field<&S::windDirection>("windDirection", "", -1, 1, "direction in which the wind blows, or the vehicle drives"),
    field<&S::windSpeed>("windSpeed", "m/s", 0, 200, "mean wind speed: 0 is still air"),
    field<&S::windGustiness>("windGustiness", "", 0, 1, "strength of gusts as a share of the wind speed"),
    field<&S::windFrequency>("windFrequency", "Hz", 0, 20, "how often gusts change"),
    field<&S::windGustSize>("windGustSize", "m", 0.01, 100, "distance over which gusts vary: lower moves locks separately"),
    field<&S::windSeed>("windSeed", "", 0, kLargestCount, "random seed of the gusts"),
    field<&S::windShelter>("windShelter", "", 0, 1, "how much spheres shelter hair: 1 guides wind around them and leaves their lee calm, 0 blows through them. Not of alternative methods"),
    choiceField<&S::collisionResponse>("collisionResponse", "how points of springs are pushed out of a sphere. Rods solve contacts together with the strand", kResponses),
    field<&S::collisionRadiusRoot>("collisionRadiusRoot", "m", 0, 0.1, "distance from spheres at the root"),
    field<&S::collisionRadiusTip>("collisionRadiusTip", "m", 0, 0.1, "distance from spheres at the tip"),
    field<&S::friction>("friction", "", 0, 1, "friction on the skin: 0 slides freely, 1 sticks"),
    field<&S::restitution>("restitution", "", 0, 1, "restitution: share of the approach speed that is kept after a bounce"),
    field<&S::penaltyFrequency>("penaltyFrequency", "Hz", 1, 10000, "stiffness of penalty springs: higher penetrates less and needs shorter time steps"),
    boolField<&S::collisionSegments>("collisionSegments", "segments of springs meet spheres between their points as well, as cylinders. Not with penalty forces"),
    boolField<&S::hairHair>("hairHair", "rods resist being pressed closer together than authored, and rub on the hair around them"),
    field<&S::hairHairStrength>("hairHairStrength", "", 0, 1, "resistance to compression: 0 is off, 1 carries about a metre of hair"),
    field<&S::hairHairFriction>("hairHairFriction", "m/s²", 0, 100, "deceleration by friction against the hair around"),
    field<&S::hairHairStickSpeed>("hairHairStickSpeed", "m/s", 0.001, 1, "hair slower than this against the hair around it sticks"),
    field<&S::hairHairCohesion>("hairHairCohesion", "1/s", 0, 100, "rate at which hair takes on the motion around it: higher moves in wisps"),
    field<&S::hairHairCell>("hairHairCell", "m", 0, 1, "size of the cells that hair is counted in: 0 chooses it from the hair's spacing"),
    field<&S::latticeNodes>("latticeNodes", "", 3, 16, "control points along each axis of the lattice: more move finer and cost more"),
    field<&S::latticeRootFrequency>("latticeRootFrequency", "Hz", 0.1, 1000, "frequency of the lattice's springs to the head at the roots"),
    field<&S::latticeTipFrequency>("latticeTipFrequency", "Hz", 0.1, 1000, "frequency of the lattice's springs to the head at the tips"),
    field<&S::latticeCouplingFrequency>("latticeCouplingFrequency", "Hz", 0, 1000, "springs between neighbouring control points of the lattice"),
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
