// SPDX-License-Identifier: MIT
#pragma once
// Authored settings of the strand engine: plain data that is saved with a hairstyle. They hold no state and
// own no memory. fieldsOf() describes them.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "hairloom/field.h"
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

/// What a strand is.
enum class StrandModel : std::uint32_t {
    rods,     ///< an inextensible elastic rod: bending and twist, one implicit solve
    springs,  ///< masses and springs (Rünz 2012), with the integrators and methods below
};

/// How segments keep their length.
enum class LengthMethod : std::uint32_t {
    constraint,       ///< Newton steps on all segments of a strand together
    springs,          ///< coil springs (Eq. 3), then maximal extension by positions (Provot 1995)
    springVelocities  ///< coil springs, then maximal extension by velocities (Bridson et al. 2003)
};

/// How strands keep their shape.
enum class AngularMethod : std::uint32_t {
    implicit,    ///< angular springs (Eq. 4), solved together along a strand; explicit integrators take
                 ///< `smallAngle`
    smallAngle,  ///< angular springs as forces towards the rest position
    exact,       ///< angular springs as forces across the segment
    flexion,     ///< springs between every second point; they have several rest shapes
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

/// Units, ranges and meanings stand in fieldsOf(); a value outside is refused by Engine::make, not clamped.
struct SimulationSettings {
    StrandModel strandModel = StrandModel::rods;

    // --- Time ---
    Integrator integrator = Integrator::verlet;
    /// In a frame of 1/60 s; frames of another length take as many as keep the step (substepsIn).
    std::uint32_t substeps = 2;
    /// Does not depend on the frame rate or the substeps.
    float dampingTime = 0.5f;
    /// Also of spheres. What moves farther carries its strand along rigidly instead of whipping it.
    float teleportDistance = 2.0f;
    float sleepSpeed = 0.002f;
    float sleepDelay = 0.4f;

    // --- Length ---
    std::uint32_t clampedPoints = 2;
    LengthMethod lengthMethod = LengthMethod::constraint;
    /// Newton steps.
    std::uint32_t lengthIterations = 1;
    /// Only while lengthIterations is not 0; hair breaks at 0.48.
    float maximalExtension = 0.005f;
    float springFrequency = 200.0f;

    // --- Shape ---
    AngularMethod angularMethod = AngularMethod::implicit;
    /// The bending stiffness EI/(ρA) is kHairBendingStiffness · s/(1 − s), the same at any number of
    /// segments.
    float angularStiffness = 0.3f;
    Ramp angularCurve = Ramp::straight(1.0f, 0.5f);
    /// GJ/EI of rods; 0.75 is a round section whose Poisson ratio is 1/3.
    float torsionRatio = 0.75f;
    /// Short over long diameter of the section of rods, an ellipse of the round one's area; its long diameter
    /// is the axis that hair curls about.
    float sectionRatio = 1.0f;
    /// Kelvin-Voigt.
    float bendDampingTime = 0.03f;
    /// Of rods and projective equations. At 1 hair keeps its authored shape as far as its stiffness can carry
    /// it.
    float restGravity = 1.0f;

    // --- Air and gravity ---
    Float3 gravity{0.0f, -9.81f, 0.0f};
    /// Of hair broadside to the air; falling hair reaches g/airDrag.
    float airDrag = 2.0f;
    WindKind windKind = WindKind::turbulent;
    /// Its length does not count.
    Float3 windDirection{1.0f, 0.0f, 0.0f};
    float windSpeed = 0.0f;
    float windGustiness = 0.3f;
    float windFrequency = 0.5f;
    float windGustSize = 0.5f;
    std::uint32_t windSeed = 1;

    // --- Collision with spheres ---
    CollisionResponse collisionResponse = CollisionResponse::radial;
    /// Of a strand: the distance that its points keep from spheres. Grows linearly to collisionRadiusTip. A
    /// larger one keeps the middle of long segments out of a sphere.
    float collisionRadiusRoot = 0.0f;
    float collisionRadiusTip = 0.002f;
    /// Coulomb.
    float friction = 0.3f;
    float restitution = 0.0f;
    float penaltyFrequency = 100.0f;

    friend bool operator==(const SimulationSettings&, const SimulationSettings&) = default;
};
/// In the order in which a panel shows them; each member stands there once.
std::span<const Field<SimulationSettings>> fieldsOf(const SimulationSettings&);

/// Of a usual frame, from which on the methods of StrandModel::springs are of use.
inline constexpr std::uint32_t kSpringSubsteps = 8;
inline constexpr float kUsualFrame = 1.0f / 60.0f;  ///< seconds
inline constexpr std::uint32_t kMaxSubsteps = 256;  ///< of a frame, whatever its length

/// Substeps of a frame of `dt` seconds: no longer than those of a usual frame, so that motion does not depend
/// on the frame rate; at most kMaxSubsteps.
std::uint32_t substepsIn(const SimulationSettings& settings, float dt);

/// Of angularStiffness anywhere along a strand, 0…1.
float greatestStiffness(const SimulationSettings& settings);

/// Young's modulus of hair, Pa (Robbins 2002, as Rünz 2012, Section 2).
inline constexpr double kYoungsModulus = 3.89e9;
/// Of hair, kg/m³; a round number, since it varies with moisture.
inline constexpr double kHairDensity = 1300.0;
/// EI/(ρA) of round hair of 80 µm, in m⁴/s²: E d²/(16 ρ).
inline constexpr double kHairBendingStiffness = kYoungsModulus * 80e-6 * 80e-6 / (16.0 * kHairDensity);

/// Names of integrators in the order of their values, as in files and on the command line.
std::vector<std::string> integratorNames();
const char* nameOf(Integrator integrator);

/// "airDrag is -1 1/s; expected 0 to 1000", one for every value outside its range; empty when all is well.
std::vector<std::string> validate(const SimulationSettings& settings);

}  // namespace hairloom::runtime
