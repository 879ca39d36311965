// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/job.h"

#include "cli/finite_numbers.h"

namespace hairloom::cli {

Jobs::Jobs(CLI::App& app) {
    for (const Job& job : jobs()) {
        CLI::App* const command = app.add_subcommand(job.name, job.does);
        command->footer("Example:\n  hairloom-cli " + job.name + " " + job.example);
        command->parse_complete_callback([this, run = job.declare(*command)] { chosen_ = run; });
        refuseNumbersThatAreNone(*command);
    }
}

}  // namespace hairloom::cli
