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

#include "runtime/math.h"

namespace hairloom::runtime {

enum class Integrator : std::uint32_t {
    verlet,  ///< position Verlet (Rünz 2012, Eq. 10)
};

/// Ranges stand in fields(); a value outside is refused by Engine::make, not clamped.
struct SimulationSettings {
    // --- Time ---
    /// How motion is advanced.
    Integrator integrator = Integrator::verlet;
    /// Steps per frame, 1…64. More: stiffer, more exact, proportionally slower.
    std::uint32_t substeps = 8;
    /// Seconds after which motion relative to the root has fallen to 1/e, 0…100; 0 is no damping. Lower:
    /// calmer hair. It does not depend on the frame rate or the substeps.
    float dampingTime = 0.5f;
    /// Metres, 0.01…10000. A root or sphere that moves farther within one frame is taken for a cut: it
    /// carries its strand along rigidly instead of whipping it.
    float teleportDistance = 2.0f;

    // --- Strand ---
    /// Points at the root that follow the scalp rigidly, 1…2. 1: the root is a hinge; 2: hair leaves the skin
    /// in its authored direction.
    std::uint32_t clampedPoints = 2;
    /// Newton steps per substep that restore segment lengths, 0…16; 0 lets segments stretch freely.
    std::uint32_t lengthIterations = 1;
    /// Extension of a segment that is never exceeded, as a share of its length, 0…0.48 (hair breaks at 0.48).
    /// Only while lengthIterations is not 0.
    float maximalExtension = 0.005f;
    /// 0…1. How strongly hair returns to its authored shape; 0 is off, 1 is rigid. At
    /// 0.5 a 1 cm segment on a fixed one swings about its rest direction at 100 rad/s.
    float angularStiffness = 0.3f;
    /// 0…1. angularStiffness at the tip as a share of that at the root. Lower: looser tips.
    float angularTipShare = 0.5f;

    // --- Air and gravity ---
    /// m/s², each component −1000…1000.
    Float3 gravity{0.0f, -9.81f, 0.0f};
    /// 1/s, 0…1000. Rate at which hair broadside to the air takes on its speed; falling hair reaches
    /// g/airDrag. 0: hair does not feel air or wind.
    float airDrag = 2.0f;
    /// Direction in which the wind blows, each component −1…1; its length does not count.
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
    /// Metres, 0…0.1. Distance that points keep from a sphere at the root, growing linearly to
    /// pearlRadiusTip. Larger pearls keep the middle of long segments out of a sphere.
    float pearlRadiusRoot = 0.0f;
    /// Metres, 0…0.1; see pearlRadiusRoot.
    float pearlRadiusTip = 0.002f;
    /// 0…1, Coulomb. 0: hair slides freely over skin; 1: it sticks.
    float friction = 0.3f;
    /// 0…1. Share of the approaching speed that is kept when bouncing off.
    float restitution = 0.0f;

    friend bool operator==(const SimulationSettings&, const SimulationSettings&) = default;
};

/// One authored field. For a Float3 the range holds for each component; for an enumeration it is that of the
/// index.
struct FieldInfo {
    using Member = std::variant<float SimulationSettings::*, std::uint32_t SimulationSettings::*,
                                Float3 SimulationSettings::*, Integrator SimulationSettings::*>;
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

/// 3 for a Float3, else 1.
std::uint32_t componentCount(const FieldInfo& field);
/// Value of component < componentCount(field); an enumeration as its index.
double fieldValue(const SimulationSettings& settings, const FieldInfo& field, std::uint32_t component = 0);
double defaultValue(const FieldInfo& field, std::uint32_t component = 0);
/// Sets it when the value is finite, in range and, for counts and enumerations, whole; else false and no
/// change.
bool setFieldValue(SimulationSettings& settings, const FieldInfo& field, double value,
                   std::uint32_t component = 0);

struct FieldProblem {
    const FieldInfo* field;
    std::uint32_t component;
    double value;
    std::string message;  ///< "airDrag is -1 1/s; expected 0 to 1000"
};
/// Every field that lies outside its range; empty when all is well.
std::vector<FieldProblem> validate(const SimulationSettings& settings);

}  // namespace hairloom::runtime
