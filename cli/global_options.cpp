// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/global_options.h"

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

namespace hairloom::cli {

void addGlobalOptions(CLI::App& app, GlobalOptions& options) {
    app.set_version_flag("--version", "hairloom-cli " HAIRLOOM_VERSION);
    app.add_flag("--json", options.json, "Print exactly one JSON object on standard output");
    app.add_option("--threads", options.threads,
                   "Number of threads, 0 for one per core. Results do not depend on it")
        ->check(CLI::Range(0, 1024));
    app.add_flag("--quiet", options.quiet, "Print no warnings on standard error");
    app.add_flag("--profile", options.profile, "Print the time of each part of the job on standard error");
    app.add_flag("--force", options.force,
                 "Allow overwriting an input, another kind of file, a read-only file, a device or a FIFO");
    app.add_flag(
        "--manifest", options.manifest,
        "Write a manifest beside the outputs: their bytes and hashes, the files that were read, what the "
        "groom holds, program and command");
    app.add_flag(
        "--allow-unconfined", options.allowUnconfined,
        "Read foreign files even if the process that reads them cannot be confined (docs/security.md)");
}

}  // namespace hairloom::cli
