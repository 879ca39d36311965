// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A sweep: one job of the command line, and the values to run it with. docs/farm.md describes the file.

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/job.h"

namespace hairloom::cli {

inline constexpr std::size_t kMaxParts = 100'000;

/// One run of the job.
struct SweepPart {
    std::size_t number = 0;
    std::string name;  ///< of its folder: "0007"
    Report values;     ///< of each axis, by its name
    /// Words behind the name of the job, where "{out}" stands for the folder of the part.
    std::vector<std::string> words;
};

struct Sweep {
    std::string file;              ///< as it was named
    std::filesystem::path folder;  ///< of the file: where names of files in it start
    std::string name;              ///< of the file, without its ending
    std::string job;
    bool gather = false;  ///< all outputs of parts, in one folder
    std::vector<SweepPart> parts;
};

/// Reads a sweep and checks the command line of each part, or of `only` one, without running any. Errors: a
/// file that cannot be read, members that are missing or wrong, a job or an option that does not exist, a
/// value that an option does not take, more than kMaxParts parts.
Result<Sweep> readSweep(const std::string& file, std::optional<std::size_t> only = {});

/// Numbers of parts as queues write them: "7", "3-5", "1-9:2", "1-3,7,8". In order, each once. Errors: no
/// such list, a part that is not there.
Result<std::vector<std::size_t>> partNumbers(const std::string& list, std::size_t parts);

/// The words with the folder in place of "{out}".
std::vector<std::string> wordsIn(const std::filesystem::path& folder, const SweepPart& part);

/// "part 0007 (groom short.hairloom, turn 45)"
std::string inWords(const SweepPart& part);

}  // namespace hairloom::cli
