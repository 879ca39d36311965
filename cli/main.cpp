// SPDX-License-Identifier: GPL-3.0-or-later
// hairloom-cli: every job of the editor without a window.

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <cstdio>
#include <exception>
#include <string>

#include "cli/job.h"
#include "core/base/log.h"
#include "core/base/parallel.h"
#include "core/base/profiler.h"

namespace {

using hairloom::cli::Report;

enum ExitCode { kDone = 0, kFailed = 1, kWrongUsage = 2 };

void printForPeople(const Report& report) {
    for (const auto& [key, value] : report.items()) {
        if (value.is_array()) {
            fmt::print("{}:{}\n", key, value.empty() ? " none" : "");
            for (const auto& row : value)
                fmt::print("  {}\n", row.is_string() ? row.get<std::string>() : row.dump());
        } else {
            fmt::print("{}: {}\n", key, value.is_string() ? value.get<std::string>() : value.dump());
        }
    }
}

/// The program by its bare name: where it lies on this machine says nothing.
std::string joined(int argc, char** argv) {
    std::string text = "hairloom-cli";
    for (int i = 1; i < argc; ++i) text += fmt::format(" {}", argv[i]);
    return text;
}

/// What the parts of the job took, the costliest first.
void printProfile() {
    fmt::print(stderr, "{:>12} {:>9}  part (ms are summed over threads)\n", "ms", "calls");
    for (const auto& [name, calls, milliseconds] : hairloom::profiler::report())
        fmt::print(stderr, "{:>12.3f} {:>9}  {}\n", milliseconds, calls, name);
}

int runChosenJob(const hairloom::cli::Jobs& jobs, const std::string& commandLine, bool json) {
    const auto report = jobs.run(commandLine);
    if (!report) {
        fmt::print(stderr, "error: {}\n", report.error().message());
        return kFailed;
    }
    if (json) {
        // Names and messages may quote bytes of damaged files, which need not be valid UTF-8.
        fmt::print("{}\n", report->dump(2, ' ', false, Report::error_handler_t::replace));
    } else {
        printForPeople(*report);
    }
    return kDone;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("Hairloom: author hairstyles for games, without a window.");
    app.require_subcommand(1);
    // On Windows, too, a word that begins with a slash is a path.
    app.allow_windows_style_options(false);
    app.fallthrough();
    app.set_version_flag("--version", "hairloom-cli " HAIRLOOM_VERSION);
    bool json = false;
    std::size_t threads = 0;
    bool quiet = false;
    bool profile = false;
    app.add_flag("--json", json, "Print exactly one JSON object on standard output");
    app.add_option("--threads", threads, "Threads to use, 0 for one per core; results do not depend on it")
        ->check(CLI::Range(0, 1024));
    app.add_flag("--quiet", quiet, "No warnings on standard error");
    app.add_flag("--profile", profile, "Print on standard error what the parts of the job took");

    const hairloom::cli::Jobs jobs(app);

    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? kDone : kWrongUsage;
    }
    if (quiet) hairloom::log::setThreshold(hairloom::log::Level::Error);
    try {
        hairloom::setThreadCount(threads);
        const int exitCode = runChosenJob(jobs, joined(argc, argv), json);
        if (profile) printProfile();
        return exitCode;
    } catch (const std::bad_alloc&) {
        fmt::print(stderr, "error: out of memory\n");
    } catch (const std::exception& error) {
        fmt::print(stderr, "error: {}\n", error.what());
    }
    return kFailed;
}
