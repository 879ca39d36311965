// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How the hair moves in the preview.

#include <string>

#include "core/simulation/simulation.h"

namespace hairloom::editor {

/// Of the preview alone: what is exported moves by the strand engine.
struct PlayedMethod {
    SimulationMethod method = SimulationMethod::strands;

    /// Why nothing but the CPU can run it; empty where a device can.
    std::string whyCpu() const {
        if (method == SimulationMethod::projective) return "projective equations run there";
        if (method == SimulationMethod::chain) return "rigid chains run there";
        if (method == SimulationMethod::lattice) return "lattices run there";
        if (method == SimulationMethod::particles) return "particles run there";
        if (method == SimulationMethod::hybrid) return "hybrids of grid and strands run there";
        return {};
    }
    friend bool operator==(const PlayedMethod&, const PlayedMethod&) = default;
};

}  // namespace hairloom::editor
