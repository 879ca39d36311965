// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A sweep as a job of a queue that is there already. Both call `hairloom-cli sweep --parts` on other
// machines, which see the same folders.

#include <string>
#include <vector>

#include "cli/sweep_parts.h"

namespace hairloom::cli {

struct QueueOptions {
    std::size_t chunk = 0;            ///< parts of a task; 0: so many that there are at most 1,000 tasks
    std::vector<std::string> sbatch;  ///< further options of sbatch: "--partition=long"
    bool submit = true;
};

/// Writes OUT/slurm/array.sh and OUT/slurm/merge.sh and hands both to sbatch. Keys: tasks, script,
/// merge_script, array_job, merge_job. Errors: no sbatch, what it says.
Result<Report> submitToSlurm(const SweepFolder& folder, const QueueOptions& options);

/// Writes `directory`/template.json, a job template of Open Job Description 2023-09 whose tasks are chunks of
/// parts. Keys: template, tasks.
Result<Report> writeOpenJdTemplate(const SweepFolder& folder, const std::filesystem::path& directory,
                                   const QueueOptions& options);

}  // namespace hairloom::cli
