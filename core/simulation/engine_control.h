// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Turning the strand engine's knobs while it runs.

#include "core/simulation/strand_method.h"

namespace hairloom {

/// Other settings from the next step on, without a jump. Errors: settings out of range, or a method that is
/// not makeEngineMethod()'s.
Status setEngineSettings(StrandMethod& method, const runtime::SimulationSettings& settings);

}  // namespace hairloom
