// SPDX-License-Identifier: MIT
#pragma once
// Whether settings are stable before they are run: the fastest wave of the hair against the step that its
// integrator can take, and what would help. docs/stability.md has the limits and how they were measured.
//
// Steps: linear theory around the rest shape, which does not know motion of roots and collisions other than
// penalty springs. Whether springs tremble at rest, as they do in curled hair at any step (docs/engine.md),
// is tried on some strands.

#include <string>
#include <vector>

#include "hairloom/settings.h"
#include "hairloom/strands.h"

namespace hairloom::runtime {

/// What a step can be too long for.
enum class Stiff : std::uint32_t {
    nothing,  ///< no force that is not solved implicitly
    coils,    ///< coil springs, along the strand
    bending,  ///< angular or flexion springs, with the tension under gravity and wind
    penalty,  ///< penalty springs
    air,      ///< drag
};

/// Angular frequencies of the fastest waves, rad/s; the greatest of all strands, 0 where a force is off. They
/// are those of the forces themselves, however an integrator takes them.
struct FastestWaves {
    double coils = 0.0;
    double bending = 0.0;
    double tension = 0.0;  ///< of hair without stiffness under its weight and the wind
    double penalty = 0.0;
};
FastestWaves fastestWaves(const StrandsView& strands, const SimulationSettings& settings);

/// Greatest ω·h at which an integrator does not amplify a wave of ω: 2 for position Verlet, velocity Verlet,
/// leapfrog and for what implicit Euler leaves explicit, 2√2 for RK4, and for explicit Euler what the damping
/// of `dampingTime` outweighs, 0 without. `h` in seconds.
double stableLimit(const SimulationSettings& settings, double h);

struct StableRegion {
    Stiff cause = Stiff::nothing;
    double frequency = 0.0;  ///< rad/s, or 1/s for air
    double step = 0.0;       ///< h, seconds of a substep
    double limit = 0.0;      ///< of frequency · step
    double factor = 0.0;     ///< frequency · step / limit; above 1 is unstable, infinite where nothing helps

    bool stable() const { return factor <= 1.0; }
};

/// Rods have no limit. Of substeps of frames of `frameTime` seconds, above 0. The forces that the integrator
/// solves implicitly do not count.
StableRegion stableRegion(const StrandsView& strands, const SimulationSettings& settings, float frameTime);

/// The longest stable substep, seconds: 0 where none is, infinite where 1/60 s is, which is the longest that
/// there is. `waves` are those of the settings, which may have another integrator.
double longestStableStep(const FastestWaves& waves, const SimulationSettings& settings);

/// Springs of some strands, the most curved among them, left alone: no wind, no spheres, roots at rest.
struct RestTrial {
    std::uint32_t strands = 0;  ///< 0 for rods, and where the trial would take long
    std::uint32_t moving = 0;   ///< of them, faster than kTrialSpeed after kTrialSeconds
    float fastest = 0.0f;       ///< m/s

    bool trembles() const { return moving > 0; }
};
inline constexpr double kTrialSeconds = 4.0;
inline constexpr float kTrialSpeed = 0.005f;  ///< m/s

/// Runs the engine; the same bits for the same input. Motion is damped in half a second or faster, so that
/// hair which swings on because it is not damped does not count.
RestTrial tryRest(const StrandsView& strands, const SimulationSettings& settings, float frameTime);

/// Settings that are stable, and what is different about them.
struct StableOffer {
    std::string words;
    SimulationSettings settings;
};

struct StableAdvice {
    StableRegion region;
    RestTrial rest;     ///< of settings inside their region
    std::string words;  ///< what is the matter; empty where all is well
    /// Best first: more substeps, where kMaxSubsteps suffice, then springs without a limit that come to rest,
    /// a tenth inside their own stable region, then rods. Where hair trembles rods are first. Empty where all
    /// is well.
    std::vector<StableOffer> offers;
};
StableAdvice adviseStability(const StrandsView& strands, const SimulationSettings& settings, float frameTime);

}  // namespace hairloom::runtime
