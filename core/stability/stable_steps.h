// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The time step at which each way to move a hairstyle would fail.

#include <string>
#include <vector>

#include "core/groom/groom.h"

namespace hairloom {

struct StableStep {
    std::string method;      ///< "rods", or the integrator of springs
    double longest = 0;      ///< stable substep, seconds, as runtime::longestStableStep()
    bool isOfGroom = false;  ///< what the groom is moved by
};

/// Rods, then springs with each integrator, with the groom's other settings; by linear theory around the
/// shape at rest, of up to 2,000 strands spread over all.
std::vector<StableStep> stableSteps(const Groom& groom);

/// "fails beyond a substep of 3.1 ms", "fails at any step", "fails at no step".
std::string failureInWords(const StableStep& step);

}  // namespace hairloom
