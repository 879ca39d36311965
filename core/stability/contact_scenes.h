// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Scenes in which a rod touches something and closed equations say what is due: docs/contact.md lists what
// comes out, tests hold it.

#include <cstdint>
#include <vector>

#include "core/stability/falling_chain.h"

namespace hairloom {

/// A straight strand falls on a sphere of 5 cm for 0.8 s, beside FallingChain.
class FallOnASphere {
  public:
    /// Runs the chain, in some seconds.
    FallOnASphere();
    /// Metres that the engine is off with that many substeps, root mean square over points and frames.
    double error(std::uint32_t substeps) const;

  private:
    std::vector<FallingChain> frames_;
};

/// Metres that a point slides, and what is due.
struct Slide {
    double slid = 0.0, due = 0.0;
};
/// A point on a rod of one metre lies for a second on a plane with friction of 0.3 that is `over` times as
/// steep as friction holds.
Slide slideOnAPlane(double over, std::uint32_t substeps);

/// Tension of a strand that slides over a round bar: on the side of the root by that on the side of the tip.
struct Capstan {
    double ratio = 0.0;  ///< as its catenary says
    double due = 0.0;  ///< dT = µ (T + ρ g r sin α) dα + ρ g r cos α dα: e^{µθ} and the weight on the bar
    double wrap = 0.0;  ///< θ, radians
};
/// From its root a strand sags to a bar of 6 cm, lies over it and hangs down behind it. The root goes away
/// from the bar at 3 cm/s, so that all that touches slides. Friction from 0.1 on: it calms the strand.
Capstan strandOverABar(float friction, std::uint32_t substeps);

/// A level strand that falls on a sphere of that restitution.
struct Bounce {
    double speed = 0.0;   ///< m/s of the fastest point after 15 s, default damping
    double gained = 0.0;  ///< J above what it started with, of a strand that nothing damps
};
Bounce bounceOnASphere(float restitution);

/// Strands whose speed the energy guard takes in four seconds of gravity that changes by 10 % a frame.
std::uint32_t guardedWhereGravityChanges();

/// m/s of the fastest point 15 s after a random storm of hard case 26.
double speedAfterStorm(std::uint32_t seed);

}  // namespace hairloom
