// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "hairloom/settings.h"

namespace hairloom::runtime {

/// The defaults, for strands as masses and springs.
inline SimulationSettings springSettings() {
    SimulationSettings s;
    s.strandModel = StrandModel::springs;
    s.substeps = kSpringSubsteps;
    return s;
}

}  // namespace hairloom::runtime
