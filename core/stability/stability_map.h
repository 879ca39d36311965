// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Where an integrator is stable: an undamped strand is pushed at many steps and stiffnesses, and its energy
// is watched.

#include <cstdint>
#include <string>
#include <vector>

#include "core/charts/plot.h"
#include "hairloom/settings.h"

namespace hairloom {

/// What pulls the strand back.
enum class MappedForce {
    coils,    ///< coil springs, pushed along the strand
    angular,  ///< angular springs, by the integrator's default method, pushed across it
};
const char* forceName(MappedForce force);

struct StabilityProbe {
    bool stable = false;
    double growth = 0.0;  ///< of the swing, from its beginning to the last quarter; infinite when it broke
    double adviceFactor = 0.0;  ///< what runtime::stableRegion() says of it: above 1 is unstable
    double omegaStep = 0.0;     ///< ω h of the strand's fastest wave
};

/// Pushes a straight strand of 8 segments of 1 cm, all equally stiff, for one step of `h` seconds, and lets
/// it swing for `steps` more, at least 8. Stable: the swing does not grow to more than thrice what it began
/// with. `stiffness`: springFrequency in Hz for coils, angularStiffness for angular springs.
StabilityProbe probeStability(runtime::Integrator integrator, MappedForce force, double h, double stiffness,
                              std::uint32_t steps = 2000);

/// ω of the fastest wave of that strand, rad/s.
double fastestWave(runtime::Integrator integrator, MappedForce force, double stiffness);

/// The ω h beyond which probeStability() sees growth, by theory: the integrator's limit; for explicit Euler,
/// which amplifies a wave by √(1 + ω²h²) at any step, where that amounts to thrice within `steps`; infinite
/// for what is solved implicitly.
double theoreticalLimit(runtime::Integrator integrator, MappedForce force, std::uint32_t steps = 2000);

struct StabilityMap {
    runtime::Integrator integrator = {};
    MappedForce force = {};
    std::uint32_t steps = 0;
    std::vector<double> stepSeconds;     ///< columns, ascending
    std::vector<double> stiffnesses;     ///< rows, ascending; Hz or angularStiffness
    std::vector<StabilityProbe> probes;  ///< row after row
    double limit = 0.0;                  ///< theoreticalLimit()
    /// Probes on the other side of the theory than expected, farther than a tenth of ω h from the border
    /// (explicit Euler: than thrice, beyond it).
    std::uint32_t surprises = 0;
};

StabilityMap mapStability(runtime::Integrator integrator, MappedForce force, std::uint32_t cells = 24,
                          std::uint32_t steps = 2000);

/// A filled map with the theoretical border over it.
Plot stabilityPlot(const StabilityMap& map);

}  // namespace hairloom
