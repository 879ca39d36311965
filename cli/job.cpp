// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/job.h"

namespace hairloom::cli {

CLI::App& Jobs::add(const std::string& name, const std::string& does, const std::string& example,
                    std::function<Result<Report>()> run) {
    CLI::App* job = app_.add_subcommand(name, does);
    job->footer("Example:\n  hairloom-cli " + name + " " + example);
    job->parse_complete_callback([this, run = std::move(run)] { chosen_ = run; });
    return *job;
}

Result<Report> Jobs::run() const {
    return chosen_();
}

}  // namespace hairloom::cli
