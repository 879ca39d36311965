// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/accuracy/machine.h"

#include <thread>

#include "core/base/parallel.h"
#include "runtime/engine.h"

namespace hairloom {

Machine thisMachine() {
    return {std::thread::hardware_concurrency(), threadCount(), runtime::Engine::instructionSet()};
}

}  // namespace hairloom
