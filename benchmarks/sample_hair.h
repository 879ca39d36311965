// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The sample hairstyles, which every benchmark of hair measures first.

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "benchmarks/benchmark.h"
#include "core/cost/step_cost.h"
#include "core/groom/groom.h"

namespace hairloom::benchmarks {

struct Sample {
    std::string name;  ///< "short sample"
    Groom groom;
};
/// Of samples. Errors: there is none beside the program or above it.
Result<std::filesystem::path> sampleFolder();
/// From short to long hair; made from the folder `samples` at the first call. Errors: there is no such folder
/// beside the program or above it, a sample does not read.
const Result<std::vector<Sample>>& samples();

/// "100000x16": 10,000 guides of 16 points on a ball, and ten hairs around each.
Sample manyHairs();

/// The hairstyles that Options::grooms names, or samples() where it names none. Errors: one is neither a
/// sample, a file nor 100000x16; a file does not read.
Result<std::vector<Sample>> wantedHair(const Options& options);

/// A groom's strands on a nodding head. Errors: those of SceneInput::make.
Result<std::unique_ptr<MovingStrands>> nodding(const Groom& groom);

}  // namespace hairloom::benchmarks
