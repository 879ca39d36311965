// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/cost/machine.h"

#include <fstream>
#include <thread>

#include "core/base/parallel.h"
#include "hairloom/engine.h"

namespace hairloom {
namespace {

/// Linux names it here.
std::string processorName() {
    std::ifstream file("/proc/cpuinfo");
    std::string line;
    while (std::getline(file, line)) {
        const std::size_t colon = line.find(": ");
        if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
    }
    return {};
}

}  // namespace

Machine thisMachine() {
    return {processorName(), std::thread::hardware_concurrency(), threadCount(),
            runtime::Engine::instructionSet()};
}

}  // namespace hairloom
