// SPDX-License-Identifier: GPL-3.0-or-later
// hairloom-cli: every job of the editor without a window.

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>

#include "cli/error_report.h"
#include "cli/finite_numbers.h"
#include "cli/global_options.h"
#include "cli/help_format.h"
#include "cli/job.h"
#include "cli/outputs.h"
#include "cli/usage_error.h"
#include "core/base/log.h"
#include "core/base/output_file.h"
#include "core/base/parallel.h"
#include "core/base/profiler.h"
#include "core/base/utf8.h"
#include "core/base/write_rules.h"
#include "core/groom/file/json_words.h"
#include "importers/reader_security.h"

namespace {

using hairloom::cli::Report;

enum ExitCode { kDone = 0, kFailed = 1, kWrongUsage = 2 };

/// Names may quote bytes of damaged files, which need not be valid UTF-8.
std::string textOf(const Report& value) {
    return hairloom::cleanUtf8(value.is_string()
                                   ? value.get<std::string>()
                                   : value.dump(-1, ' ', false, Report::error_handler_t::replace));
}

/// Numbers have as many digits as a person reads; `--json` has all. Rows that say themselves in words stand
/// so.
void printForPeople(std::FILE* stream, const Report& exact) {
    const Report report = hairloom::withFewDigits(exact);

    for (const auto& [key, value] : report.items()) {
        if (value.is_array()) {
            fmt::print(stream, "{}:{}\n", key, value.empty() ? " none" : "");
            for (const auto& row : value)
                fmt::print(stream, "  {}\n",
                           textOf(row.is_object() && row.contains("words") ? row["words"] : row));
        } else {
            fmt::print(stream, "{}: {}\n", key, textOf(value));
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

int failWith(const hairloom::Error& error, bool json) {
    hairloom::cli::printError(error, json);
    return kFailed;
}

int runChosenJob(const hairloom::cli::Jobs& jobs, const std::string& commandLine, bool json, bool manifest) {
    const auto report = jobs.run(commandLine, manifest);
    if (!report) return failWith(report.error(), json);
    try {
        if (json) {
            fmt::print("{}\n", report->dump(2, ' ', false, Report::error_handler_t::replace));
        } else {
            printForPeople(hairloom::cli::writesToStandardOutput() ? stderr : stdout, *report);
        }
    } catch (const std::system_error&) {
        // fmt's word for a stream that takes no more; flushOutput() has the reason.
    }
    if (const auto flushed = hairloom::cli::flushOutput(); !flushed) return failWith(flushed.error(), false);
    return kDone;
}

int failUsage(const hairloom::Error& error, bool json) {
    hairloom::cli::printError(error, json);
    return kWrongUsage;
}

/// What the parser says goes where it belongs: help and version are answers, all else is wrong usage.
int endParsing(const CLI::App& app, const CLI::ParseError& error, bool json) {
    if (error.get_exit_code() != 0) {
        return failUsage(hairloom::cli::usageError(app, error), json);
    }
    app.exit(error);
    if (const auto flushed = hairloom::cli::flushOutput(); !flushed) return failWith(flushed.error(), false);
    return kDone;
}

}  // namespace

int main(int argc, char** argv) {
    hairloom::cli::keepStandardStreams();
    hairloom::removeTemporariesWhenEnded();
    CLI::App app("Hairloom: author hairstyles for games, without a window.");
    app.require_subcommand(1);
    // On Windows, too, a word that begins with a slash is a path.
    app.allow_windows_style_options(false);
    app.fallthrough();
    app.formatter(std::make_shared<hairloom::cli::HelpFormatter>());
    hairloom::cli::GlobalOptions options;
    hairloom::cli::addGlobalOptions(app, options);

    const hairloom::cli::Jobs jobs(app);
    hairloom::cli::refuseNumbersThatAreNone(app);

    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        // The flag may stand behind what could not be read.
        const auto isJson = [](const char* word) { return std::string_view(word) == "--json"; };
        return endParsing(app, error, std::any_of(argv + 1, argv + argc, isJson));
    }
    hairloom::setWriteRules({options.force, true, "choose another name, or use --force"});
    hairloom::cli::reportsAsJson(options.json);
    hairloom::allowUnconfinedReaders(options.allowUnconfined);
    if (options.quiet) hairloom::log::setThreshold(hairloom::log::Level::Error);
    try {
        hairloom::cli::refuseEmptyItems(app, {argv + 1, argv + argc});
        hairloom::setThreadCount(options.threads);
        const int exitCode = runChosenJob(jobs, joined(argc, argv), options.json, options.manifest);
        if (options.profile) printProfile();
        return exitCode;
    } catch (const hairloom::cli::WrongUsage& error) {
        return failUsage(hairloom::expecting(error.error(), "see hairloom-cli JOB --help"), options.json);
    } catch (const std::bad_alloc&) {
        return failWith({{}, {}, "the job ran out of memory", "expected a smaller input, or more memory"},
                        options.json);
    } catch (const std::exception& error) {
        return failWith({{},
                         {},
                         fmt::format("the job stopped with an unexpected error ({}), and nothing was written",
                                     error.what()),
                         "please report it with the command and its input"},
                        options.json);
    }
}
