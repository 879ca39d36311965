// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>

namespace hairloom {

/// Where times were measured.
struct Machine {
    std::string processor;       ///< as it calls itself; empty where the system does not say
    unsigned cores = 0;          ///< hardware threads; 0 where the system does not say
    std::size_t threads = 0;     ///< that loops use now
    std::string instructionSet;  ///< of the engine's vector code
};
Machine thisMachine();

}  // namespace hairloom
