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

/// Each member has its unit, range and meaning, as fieldsOf() describes it (a test compares). Engine::make()
/// refuses a value outside and does not clamp it.
struct SimulationSettings {
    /// Strand model: an elastic rod, or masses and springs with the methods below.
    StrandModel strandModel = StrandModel::rods;

    // --- Time ---
    /// Time integration of springs. With lengths held, verlet, velocityVerlet and rk4 are of order 2, the
    /// others of order 1.
    Integrator integrator = Integrator::verlet;
    /// 1 … 256. Time steps per 1/60 s: more are more accurate and slower. A frame of another length takes as
    /// many as keep the step (substepsIn()).
    std::uint32_t substeps = 2;
    /// s, 0 … 100. Time in which motion decays to 1/e: lower is calmer, 0 is undamped. Does not depend on the
    /// frame rate or the substeps.
    float dampingTime = 0.5f;
    /// m, 0.01 … 10000. A root that moves farther than this in a frame carries its strand along (teleport).
    /// Spheres and bones do likewise.
    float teleportDistance = 2.0f;
    /// m/s, 0 … 1. Strands slower than this fall asleep: 0 keeps all awake.
    float sleepSpeed = 0.002f;
    /// s, 0 … 10. Time at rest before a strand falls asleep.
    float sleepDelay = 0.4f;

    // --- Length ---
    /// 1 … 2. Points fixed to the scalp: 1 lets the strand hinge with a spring, 2 keeps the authored
    /// direction.
    std::uint32_t clampedPoints = 2;
    /// How segments keep their length.
    LengthMethod lengthMethod = LengthMethod::constraint;
    /// 0 … 16. Length constraint iterations per substep: 0 lets hair stretch freely. Newton steps.
    std::uint32_t lengthIterations = 1;
    /// 0 … 0.48. Largest stretch of a segment, as a share of its length. Only while lengthIterations is not
    /// 0. Hair breaks at 0.48.
    float maximalExtension = 0.005f;
    /// Hz, 1 … 10000. Stiffness of coil springs: higher stretches less and needs shorter time steps.
    float springFrequency = 200.0f;

    // --- Shape ---
    /// How strands keep their shape.
    AngularMethod angularMethod = AngularMethod::implicit;
    /// 0 … 1. How strongly hair returns to its shape: 0 is off, 0.5 real hair, 1 rigid. The bending stiffness
    /// EI/(ρA) is kHairBendingStiffness · s/(1 − s), the same at any number of segments.
    float angularStiffness = 0.3f;
    /// Stiffness from root to tip, as keys [place, share]: lower is looser there.
    Ramp angularCurve = Ramp::straight(1.0f, 0.5f);
    /// 0.01 … 100. Ratio of torsional to bending stiffness of rods: 0.75 is a round fibre. GJ/EI. At 0.75
    /// Poisson's ratio of a round section is 1/3.
    float torsionRatio = 0.75f;
    /// 0.2 … 1. Ratio of the short to the long diameter of the rod's cross-section: 1 is round, 0.6 flat like
    /// curly hair. An ellipse of the area of the round one. Hair curls about its long diameter.
    float sectionRatio = 1.0f;
    /// s, 0 … 1. Bending waves faster than this are damped: 0 is undamped. Kelvin-Voigt.
    float bendDampingTime = 0.03f;
    /// 0 … 1. Share of gravity that the authored shape of rods already carries: 1 keeps the shape, 0 lets it
    /// sag. Of rods and projective equations, as far as their stiffness can carry it.
    float restGravity = 1.0f;

    // --- Air and gravity ---
    /// m/s², -1000 … 1000. Gravity, an acceleration.
    Float3 gravity{0.0f, -9.81f, 0.0f};
    /// 1/s, 0 … 1000. Rate at which hair takes on the air's velocity: 0 feels no wind. Of hair broadside to
    /// the air. Falling hair reaches g/airDrag.
    float airDrag = 2.0f;
    /// How the wind varies in space and time.
    WindKind windKind = WindKind::turbulent;
    /// -1 … 1. Direction in which the wind blows, or the vehicle drives. Its length does not count.
    Float3 windDirection{1.0f, 0.0f, 0.0f};
    /// m/s, 0 … 200. Mean wind speed: 0 is still air.
    float windSpeed = 0.0f;
    /// 0 … 1. Strength of gusts as a share of the wind speed.
    float windGustiness = 0.3f;
    /// Hz, 0 … 20. How often gusts change.
    float windFrequency = 0.5f;
    /// m, 0.01 … 100. Distance over which gusts vary: lower moves locks separately.
    float windGustSize = 0.5f;
    /// 0 … 4294967295. Random seed of the gusts.
    std::uint32_t windSeed = 1;
    /// 0 … 1. How much spheres shelter hair: 1 guides wind around them and leaves their lee calm, 0 blows
    /// through them. Not of alternative methods.
    float windShelter = 0.0f;

    // --- Collision with spheres ---
    /// How points of springs are pushed out of a sphere. Rods solve contacts together with the strand.
    CollisionResponse collisionResponse = CollisionResponse::radial;
    /// m, 0 … 0.1. Distance from spheres at the root. Grows linearly to collisionRadiusTip. A larger one
    /// keeps the middle of long segments out of a sphere.
    float collisionRadiusRoot = 0.0f;
    /// m, 0 … 0.1. Distance from spheres at the tip.
    float collisionRadiusTip = 0.002f;
    /// 0 … 1. Friction on the skin: 0 slides freely, 1 sticks. Coulomb.
    float friction = 0.3f;
    /// 0 … 1. Restitution: share of the approach speed that is kept after a bounce.
    float restitution = 0.0f;
    /// Hz, 1 … 10000. Stiffness of penalty springs: higher penetrates less and needs shorter time steps.
    float penaltyFrequency = 100.0f;
    /// Segments of springs meet spheres between their points as well, as cylinders. Not with penalty
    /// forces.
    bool collisionSegments = false;

    // --- Hair-hair collision ---
    /// Rods resist being pressed closer together than authored, and rub on the hair around them.
    bool hairHair = false;
    /// 0 … 1. Resistance to compression: 0 is off, 1 carries about a metre of hair. A pressure of 36 m²/s² at
    /// twice the authored density.
    float hairHairStrength = 0.5f;
    /// m/s², 0 … 100. Deceleration by friction against the hair around.
    float hairHairFriction = 1.0f;
    /// m/s, 0.001 … 1. Hair slower than this against the hair around it sticks. Above it, it slides.
    float hairHairStickSpeed = 0.05f;
    /// 1/s, 0 … 100. Rate at which hair takes on the motion around it: higher moves in wisps.
    float hairHairCohesion = 0.5f;
    /// m, 0 … 1. Size of the cells that hair is counted in: 0 chooses it from the hair's spacing. Below
    /// 0.001 as 0.001; larger where the authored hair would take more than 2¹⁴ cells.
    float hairHairCell = 0.0f;

    // --- Lattice, an alternative to strands ---
    /// 3 … 16. Control points along each axis of the lattice: more move finer and cost more.
    std::uint32_t latticeNodes = 6;
    /// Hz, 0.1 … 1000. Frequency of the lattice's springs to the head at the roots.
    float latticeRootFrequency = 8.0f;
    /// Hz, 0.1 … 1000. Frequency of the lattice's springs to the head at the tips.
    float latticeTipFrequency = 1.5f;
    /// Hz, 0 … 1000. Springs between neighbouring control points of the lattice.
    float latticeCouplingFrequency = 2.0f;

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
