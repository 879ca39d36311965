// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How a head is taken out of its file, for every job that reads one.

#include <CLI/App.hpp>
#include <string>
#include <vector>

#include "cli/job.h"
#include "core/documents/head_import.h"

namespace hairloom::cli {

/// As the command line has them; what is empty is guessed where the file does not say it.
struct HeadOptions {
    std::string unit, up;
    float turn = 0;
    bool saysTurn = false;
    std::vector<std::string> leaveOut;
};

/// --unit, --up, --turn and --leave-out, the first two with `prefix` before their names.
void addHeadOptions(CLI::App& job, HeadOptions& options, const std::string& prefix = {});

HeadImportOptions headImportOptions(const HeadOptions& options);

/// With what was guessed: up, turn, metres_per_unit (null where the file states it or metres were taken),
/// left_out, warnings.
Report headReport(const HeadImportOptions& taken, const std::vector<std::string>& words);

}  // namespace hairloom::cli
