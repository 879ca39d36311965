// SPDX-License-Identifier: MIT
#pragma once
// Authored settings of the strand engine: plain data that is saved with a hairstyle. They hold no state and
// own no memory. fields() lists them for validation, files, command lines and panels.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "hairloom/math.h"
#include "hairloom/ramp.h"

namespace hairloom::runtime {

/// How motion is advanced; docs/engine.md has each in symbols.
enum class Integrator : std::uint32_t {
    verlet,          ///< position Verlet (Rünz 2012, Eq. 10); angular springs implicitly
    velocityVerlet,  ///< Eq. 12
    leapfrog,        ///< half drift, kick, half drift
    explicitEuler,   ///< Eq. 7
    implicitEuler,   ///< Eq. 9, one linearised step, solved directly along each strand
    rk4,             ///< the classical Runge-Kutta method of order 4
};

/// How segments keep their length.
enum class LengthMethod : std::uint32_t {
    constraint,       ///< Newton steps on all segments of a strand together
    springs,          ///< coil springs (Eq. 3), then maximal extension by positions (Provot 1995)
    springVelocities  ///< coil springs, then maximal extension by velocities (Bridson et al. 2003)
};

/// How strands keep their shape.
enum class AngularMethod : std::uint32_t {
    implicit,  ///< angular springs (Eq. 4), solved together along a strand; explicit integrators take `cheap`
    cheap,     ///< angular springs as forces towards the rest place
    exact,     ///< angular springs as forces across the segment
    flexion,   ///< springs between every second point; they have several rest shapes
};

enum class WindKind : std::uint32_t {
    uniform,    ///< the same everywhere and always
    gusting,    ///< a mean flow whose strength comes and goes
    turbulent,  ///< a mean flow and eddies that drift with it
    vehicle,    ///< the air stream of a ride along windDirection, against it, and against the actor's motion
};

enum class CollisionResponse : std::uint32_t {
    radial,    ///< impulse (Eq. 20), then out along the radius (Eq. 21, p_a)
    backward,  ///< impulse, then back along the way it came (p_b)
    penalty,   ///< a spring that pushes out; allows some penetration
};

/// Ranges stand in fields(); a value outside is refused by Engine::make, not clamped.
struct SimulationSettings {
    // --- Time ---
    Integrator integrator = Integrator::verlet;
    /// Steps per frame, 1…64. More: stiffer, more exact, proportionally slower.
    std::uint32_t substeps = 8;
    /// Seconds after which motion relative to the root has fallen to 1/e, 0…100; 0 is no damping. Lower:
    /// calmer hair. It does not depend on the frame rate or the substeps.
    float dampingTime = 0.5f;
    /// Metres, 0.01…10000. A root or sphere that moves farther within one frame is taken for a cut: it
    /// carries its strand along rigidly instead of whipping it.
    float teleportDistance = 2.0f;
    /// m/s, 0…1. Strands slower than this for sleepDelay fall asleep until something moves them; 0 never.
    float sleepSpeed = 0.002f;
    /// Seconds, 0…10; see sleepSpeed.
    float sleepDelay = 0.4f;

    // --- Length ---
    /// Points at the root that follow the scalp rigidly, 1…2. 1: hair leaves the skin over a spring; 2: hair
    /// leaves the skin in its authored direction.
    std::uint32_t clampedPoints = 2;
    LengthMethod lengthMethod = LengthMethod::constraint;
    /// Newton steps per substep that restore segment lengths, 0…16; 0 lets segments stretch freely.
    std::uint32_t lengthIterations = 1;
    /// Extension of a segment that is never exceeded, as a share of its length, 0…0.48 (hair breaks at 0.48).
    /// Only while lengthIterations is not 0.
    float maximalExtension = 0.005f;
    /// Hz, 1…10000. How fast a segment swings along itself on coil springs. Higher: less stretch, shorter
    /// stable steps.
    float springFrequency = 200.0f;

    // --- Shape ---
    AngularMethod angularMethod = AngularMethod::implicit;
    /// 0…1. How strongly hair returns to its authored shape: the bending stiffness EI/(ρA) is
    /// kHairBendingStiffness · s/(1 − s). 0 is off, 0.5 real round hair of 80 µm, 1 rigid. The same at any
    /// number of segments.
    float angularStiffness = 0.3f;
    /// Share of angularStiffness along the strand, from the root at 0 to the tip at 1. Lower: looser there.
    Ramp angularCurve = Ramp::straight(1.0f, 0.5f);
    /// Seconds, 0…1. Kelvin-Voigt time of bending: waves slower than it pass, faster ones fade. 0 rings on.
    float bendDampingTime = 0.03f;
    /// 0…1. Share of gravity in which the authored shape hangs already. 1: hair keeps its authored shape as
    /// far as its stiffness can carry it; 0: it sags from there.
    float restGravity = 1.0f;

    // --- Air and gravity ---
    /// m/s², each component −1000…1000.
    Float3 gravity{0.0f, -9.81f, 0.0f};
    /// 1/s, 0…1000. Rate at which hair broadside to the air takes on its speed; falling hair reaches
    /// g/airDrag. 0: hair does not feel air or wind.
    float airDrag = 2.0f;
    WindKind windKind = WindKind::turbulent;
    /// Direction in which the wind blows (a vehicle: in which it drives), each component −1…1; its length
    /// does not count.
    Float3 windDirection{1.0f, 0.0f, 0.0f};
    /// m/s, 0…200. 0: still air.
    float windSpeed = 0.0f;
    /// 0…1. Strength of random gusts as a share of windSpeed.
    float windGustiness = 0.3f;
    /// Hz, 0…20. How often gusts change; 0 freezes them in space.
    float windFrequency = 0.5f;
    /// Metres, 0.01…100. Distance over which gusts differ. Lower: neighbouring locks move apart.
    float windGustSize = 0.5f;
    /// Any number; another seed gives another sequence of gusts.
    std::uint32_t windSeed = 1;

    // --- Collision with spheres ---
    CollisionResponse collisionResponse = CollisionResponse::radial;
    /// Metres, 0…0.1. Distance that points keep from a sphere at the root, growing linearly to
    /// pearlRadiusTip. Larger pearls keep the middle of long segments out of a sphere.
    float pearlRadiusRoot = 0.0f;
    /// Metres, 0…0.1; see pearlRadiusRoot.
    float pearlRadiusTip = 0.002f;
    /// 0…1, Coulomb. 0: hair slides freely over skin; 1: it sticks.
    float friction = 0.3f;
    /// 0…1. Share of the approaching speed that is kept when bouncing off.
    float restitution = 0.0f;
    /// Hz, 1…10000. How fast a point swings on the penalty spring. Higher: less penetration, shorter stable
    /// steps.
    float penaltyFrequency = 100.0f;

    friend bool operator==(const SimulationSettings&, const SimulationSettings&) = default;
};

/// Of angularStiffness anywhere along a strand, 0…1.
float greatestStiffness(const SimulationSettings& settings);

/// Young's modulus of hair, Pa (Robbins 2002, as Rünz 2012, Section 2).
inline constexpr double kYoungsModulus = 3.89e9;
/// Of hair, kg/m³; a round number, since it varies with moisture.
inline constexpr double kHairDensity = 1300.0;
/// EI/(ρA) of round hair of 80 µm, in m⁴/s²: E d²/(16 ρ).
inline constexpr double kHairBendingStiffness = kYoungsModulus * 80e-6 * 80e-6 / (16.0 * kHairDensity);

/// One authored field. For a Float3 the range holds for each component, for a Ramp for the value of each key;
/// for an enumeration it is that of the index.
struct FieldInfo {
    using Member = std::variant<float SimulationSettings::*, std::uint32_t SimulationSettings::*,
                                Float3 SimulationSettings::*, Ramp SimulationSettings::*,
                                Integrator SimulationSettings::*, LengthMethod SimulationSettings::*,
                                AngularMethod SimulationSettings::*, WindKind SimulationSettings::*,
                                CollisionResponse SimulationSettings::*>;
    const char* name;  ///< as in files and on the command line
    const char* unit;  ///< "" for a pure number
    double min;
    double max;
    const char* meaning;  ///< what turning it does, one sentence
    Member member;
    std::span<const char* const> choices;  ///< names of an enumeration's values, in order; else empty
};

/// All fields, in the order in which a panel shows them. Each member of SimulationSettings stands here once.
std::span<const FieldInfo> fields();
/// The field of that name, or null.
const FieldInfo* findField(std::string_view name);
/// Names of integrators in the order of their values, as in files and on the command line.
std::vector<std::string> integratorNames();
const char* nameOf(Integrator integrator);

/// 3 for a Float3, 0 for a Ramp, which has keys instead, else 1.
std::uint32_t componentCount(const FieldInfo& field);
/// Value of component < componentCount(field); an enumeration as its index.
double fieldValue(const SimulationSettings& settings, const FieldInfo& field, std::uint32_t component = 0);
double defaultValue(const FieldInfo& field, std::uint32_t component = 0);
/// Sets it when the value is finite, in range and, for counts and enumerations, whole; else, and for a Ramp,
/// false and no change.
bool setFieldValue(SimulationSettings& settings, const FieldInfo& field, double value,
                   std::uint32_t component = 0);

struct FieldProblem {
    const FieldInfo* field;
    std::uint32_t component;
    double value;         ///< 0 for a Ramp
    std::string message;  ///< "airDrag is -1 1/s; expected 0 to 1000"
};
/// Every field that lies outside its range; empty when all is well.
std::vector<FieldProblem> validate(const SimulationSettings& settings);

}  // namespace hairloom::runtime
