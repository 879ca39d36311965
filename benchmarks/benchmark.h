// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// All measuring of speed: `hairloom-cli bench NAME` is a door to what stands here. A benchmark is one file
// NAME_benchmark.cpp of this folder: nameBenchmark() says what it is. Those of hair have the sample
// hairstyles first, made-up scenes after them.

#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/result.h"

namespace hairloom::benchmarks {

using Report = nlohmann::ordered_json;

/// What the person asked for; empty where a benchmark has its usual.
struct Options {
    std::optional<int> repetitions;      ///< of each measurement, 1 or more
    std::vector<std::uint32_t> strands;  ///< ascending
    std::vector<std::uint32_t> hairs;
    std::vector<std::string> grooms;  ///< samples by their names without " sample", or project files
    std::vector<std::string> only;    ///< rows whose names have one of these in them
    std::optional<std::uint32_t> frames;
    bool quick = false;                                           ///< to see that it works
    std::optional<std::pair<std::uint32_t, std::uint32_t>> size;  ///< pixels of all pictures
    std::optional<std::uint32_t> device;                          ///< GPU, by its index in `devices`
    std::string commandLine;                                      ///< for the head of tables
    /// Told as it goes on; may be empty.
    std::function<void(std::string_view what, std::size_t done, std::size_t total)> progress;
};

struct Outcome {
    Report report;         ///< name, and rows of name, n, median, min, max, unit
    std::string markdown;  ///< the same as tables, where it writes them
    std::vector<std::pair<std::string, std::string>> files;  ///< name and content, where it writes some
};

struct Benchmark {
    std::string name;
    std::string measures;            ///< a few words
    std::vector<std::string> takes;  ///< options of the command line beside --repeat: "--quick"
    Result<Outcome> (*run)(const Options& options);
};

/// In order of name.
const std::vector<Benchmark>& benchmarks();

}  // namespace hairloom::benchmarks
