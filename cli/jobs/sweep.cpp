// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <numeric>
#include <optional>

#include "cli/backend.h"
#include "cli/error_report.h"
#include "cli/job.h"
#include "cli/outputs.h"
#include "cli/sweep_file.h"
#include "cli/sweep_merge.h"
#include "cli/sweep_parts.h"
#include "cli/sweep_queues.h"
#include "cli/sweep_run.h"
#include "core/base/stopwatch.h"

namespace hairloom::cli {
namespace {

namespace fs = std::filesystem;

const std::map<std::string, SweepProgress> kProgress{
    {"bar", SweepProgress::bar}, {"lines", SweepProgress::lines}, {"openjd", SweepProgress::openjd}};

struct SweepOptions {
    std::string file;
    std::string output;
    std::string parts;
    std::optional<std::size_t> part;
    bool merge = false, status = false, slurm = false, writeOnly = false;
    std::string openjd;
    QueueOptions queue;
    std::string progress = "bar";

    SweepProgress how() const { return kProgress.at(progress); }
};

Report reportOf(const SweepFolder& folder, const SweepOutcome& outcome) {
    return {{"parts", outcome.parts},          {"done", outcome.done},
            {"failed", outcome.failed},        {"missing", outcome.parts - outcome.done - outcome.failed},
            {"failures", outcome.failures},    {"part_seconds", outcome.seconds},
            {"output", folder.path().string()}};
}

std::string elsewhereText(std::size_t parts) {
    return parts == 0 ? std::string() : fmt::format(", of which another process does {} now", parts);
}

/// One that counts as done only where every part is. `elsewhere` are parts that another process does.
Result<Report> merged(const SweepFolder& folder, std::size_t elsewhere = 0) {
    const auto outcome = mergeSweep(folder);
    if (!outcome) return tl::unexpected(outcome.error());
    const std::size_t open = outcome->parts - outcome->done;
    if (open == 0) return reportOf(folder, *outcome);
    // What the other process has ended meanwhile is no longer open.
    elsewhere = std::min(elsewhere, open - outcome->failed);
    std::string failed;
    if (outcome->failed > 0)
        failed = fmt::format(", and {} of these failed: {}", outcome->failed, outcome->failures.front());
    return failIn((folder.path() / "report.html").string(), {},
                  fmt::format("{} of {} parts are not done{}{}", open, outcome->parts,
                              elsewhereText(elsewhere), failed),
                  elsewhere == open ? "wait for the other process, which joins the results"
                                    : "run the sweep again: it does what is missing");
}

Result<Report> runSome(const SweepFolder& folder, const std::vector<std::size_t>& parts,
                       SweepProgress progress) {
    const auto counts = runParts(folder, parts, progress);
    if (!counts) return tl::unexpected(counts.error());
    Report report{{"parts", parts.size()},
                  {"done", counts->done + counts->kept},
                  {"failed", counts->failed},
                  {"kept", counts->kept},
                  {"output", folder.path().string()}};
    if (counts->failed == 0 && counts->elsewhere == 0) return report;
    for (const std::size_t number : parts) {
        const SweepPart& part = folder.sweep().parts[number];
        if (const auto error = folder.failure(part))
            return failIn(error->file, error->place, fmt::format("{}: {}", inWords(part), error->problem),
                          fmt::format("{} of {} parts failed: run them again", counts->failed, parts.size()));
    }
    return failIn(folder.path().string(), {},
                  fmt::format("{} of {} parts are not done{}", counts->failed + counts->elsewhere,
                              parts.size(), elsewhereText(counts->elsewhere)),
                  "run them again later");
}

Result<Report> runOne(const SweepFolder& folder, std::size_t number) {
    if (number >= folder.sweep().parts.size())
        throw WrongUsage(fmt::format("there is no part {}", number),
                         fmt::format("expected 0 to {}", folder.sweep().parts.size() - 1));
    const SweepPart& part = folder.sweep().parts[number];
    const auto done = folder.run(part);
    if (!done) return tl::unexpected(done.error());
    return Report{{"part", number},
                  {"seconds", done->seconds},
                  {"files", done->files.size()},
                  {"report", done->report}};
}

Result<Report> runAll(const SweepFolder& folder, SweepProgress progress) {
    const Stopwatch watch;
    std::vector<std::size_t> all(folder.sweep().parts.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    const auto counts = runParts(folder, all, progress);
    if (!counts) return tl::unexpected(counts.error());
    auto report = merged(folder, counts->elsewhere);
    if (report) {
        (*report)["kept"] = counts->kept;
        (*report)["seconds"] = watch.seconds();
    }
    return report;
}

Result<Report> run(const SweepOptions& options) {
    // Its parts are processes that share the folder, so that it cannot be kept for one as other jobs' are.
    refusePipeForFolder(options.output);
    const auto sweep = readSweep(options.file, options.part);
    if (!sweep) return tl::unexpected(sweep.error());
    const fs::path out = options.output.empty() ? sweep->folder / sweep->name
                                                : fs::absolute(options.output).lexically_normal();
    const auto folder = SweepFolder::open(*sweep, out);
    if (!folder) {
        Error error = folder.error();
        if (!options.output.empty()) error.file = options.output;
        return tl::unexpected(std::move(error));
    }
    if (options.part) return runOne(*folder, *options.part);
    if (!options.parts.empty()) {
        const auto parts = orWrongUsage(partNumbers(options.parts, sweep->parts.size()));
        return runSome(*folder, parts, options.how());
    }
    if (options.merge) return merged(*folder);
    if (!options.status && !options.slurm && options.openjd.empty()) return runAll(*folder, options.how());
    Report report = reportOf(*folder, statusOf(*folder));
    Result<Report> queued = Report::object();
    if (options.slurm) queued = submitToSlurm(*folder, options.queue);
    if (!options.openjd.empty())
        queued = writeOpenJdTemplate(*folder, fs::absolute(options.openjd), options.queue);
    if (!queued) return queued;
    report.update(*queued);
    return report;
}

JobRun declare(CLI::App& job) {
    const auto options = std::make_shared<SweepOptions>();
    job.add_option("file", options->file,
                   "JSON file with a job, its arguments and the values to run it with (docs/farm.md)")
        ->required();
    job.add_option("-o,--output", options->output,
                   "Folder for parts and results (default: the file's name without .json)");
    auto* parts = job.add_option("--parts", options->parts,
                                 "Run only these parts, and join nothing: 7, 3-5, 1-9:2 or 1-3,7");
    auto* part = job.add_option("--part", options->part, "Run this part in this process");
    auto* merge = job.add_flag("--merge", options->merge, "Join the results of the parts, and run none");
    auto* status = job.add_flag("--status", options->status, "Count the parts that are done, and run none");
    auto* slurm = job.add_flag("--slurm", options->slurm,
                               "Write and submit an array of Slurm jobs, and a job that joins their results");
    auto* openjd = job.add_option("--openjd", options->openjd,
                                  "Folder for a template of Open Job Description, template.json, to write");
    const std::vector<CLI::Option*> ways{parts, part, merge, status, slurm, openjd};
    for (CLI::Option* way : ways)
        for (CLI::Option* other : ways)
            if (way != other) way->excludes(other);
    job.add_option("--chunk", options->queue.chunk,
                   "Parts in a task of a queue (default: enough for at most 1,000 tasks)")
        ->check(CLI::Range(std::size_t{1}, kMaxParts));
    job.add_flag_callback(
           "--write-only", [options] { options->queue.submit = false; },
           "Write Slurm's scripts, and do not submit them")
        ->needs(slurm);
    job.add_option("--sbatch", options->queue.sbatch, "Further option of sbatch, like --partition=long")
        ->allow_extra_args(false)
        ->needs(slurm);
    job.add_option(
           "--progress", options->progress,
           "How to show progress: a bar on a terminal, lines on standard error, or what runners of Open "
           "Job Description read")
        ->check(CLI::IsMember(namesOf(kProgress)));
    return [options](const std::string&) { return run(*options); };
}

}  // namespace

Job sweepJob() {
    return {"sweep", "Run a job with many values, here or on a farm", "storms.json -o storms", declare};
}

}  // namespace hairloom::cli
