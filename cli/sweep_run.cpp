// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/sweep_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <mutex>
#include <optional>
#include <thread>

#include "cli/progress.h"
#include "core/base/parallel.h"
#include "core/base/stopwatch.h"
#include "importers/child_process.h"
#include "importers/reader_security.h"

namespace hairloom::cli {
namespace {

constexpr double kSecondsBetweenLines = 5;

enum class Ending : std::uint8_t { done, failed, elsewhere };

/// Tells how far the parts are. Called from any thread.
class Teller {
  public:
    Teller(SweepProgress kind, std::size_t total) : kind_(kind), total_(total) {
        if (kind == SweepProgress::bar) bar_.emplace("sweep", total);
    }

    void ended(Ending how) {
        const std::scoped_lock lock(mutex_);
        ++(how == Ending::done ? done_ : how == Ending::failed ? failed_ : elsewhere_);
        const std::size_t ended = done_ + failed_ + elsewhere_;
        const double left =
            watch_.seconds() / static_cast<double>(ended) * static_cast<double>(total_ - ended);
        const std::string rest =
            fmt::format("{} failed{}, about {} left", failed_,
                        elsewhere_ > 0 ? fmt::format(", {} done by another process", elsewhere_) : "",
                        durationText(left));
        const std::string text = fmt::format("{} of {} parts done, {}", done_, total_, rest);
        if (bar_) bar_->done(ended, ", " + rest);
        if (kind_ == SweepProgress::bar || (ended < total_ && watch_.seconds() < nextLine_)) return;
        nextLine_ = watch_.seconds() + kSecondsBetweenLines;
        if (kind_ == SweepProgress::lines) {
            fmt::print(stderr, "{}\n", text);
        } else {
            fmt::print("openjd_progress: {:.1f}\nopenjd_status: {}\n",
                       100.0 * static_cast<double>(ended) / static_cast<double>(total_), text);
            std::fflush(stdout);
        }
    }
    std::size_t done() const { return done_; }
    std::size_t failed() const { return failed_; }
    std::size_t elsewhere() const { return elsewhere_; }

  private:
    SweepProgress kind_;
    std::size_t total_, done_ = 0, failed_ = 0, elsewhere_ = 0;
    std::optional<Progress> bar_;
    Stopwatch watch_;
    double nextLine_ = 0;
    std::mutex mutex_;
};

/// A process for the part. It has written what the job said; what it died of is in brackets.
Ending runInProcess(const SweepFolder& folder, const SweepPart& part, std::size_t threads) {
    ChildLimits limits;
    limits.time = std::chrono::hours(24 * 365);
    limits.residentBytes = std::numeric_limits<std::uint64_t>::max();
    limits.startsPrograms = true;
    const std::filesystem::path file = std::filesystem::absolute(folder.sweep().file);
    folder.forget(part);
    std::vector<std::string> words{"sweep", "--part=" + std::to_string(part.number),
                                   "--output=" + folder.path().string(),
                                   "--threads=" + std::to_string(threads)};
    if (areUnconfinedReadersAllowed()) words.emplace_back("--allow-unconfined");
    words.insert(words.end(), {"--", file.string()});
    const auto ran = runChild("the job", programFolder() / "hairloom-cli", words, limits);
    if (ran) return Ending::done;
    if (folder.busy(part)) return Ending::elsewhere;
    if (folder.failure(part)) return Ending::failed;
    Error error = ran.error();
    const auto open = error.problem.find('('), close = error.problem.rfind(')');
    if (open != std::string::npos && close != std::string::npos && open < close)
        error = {{},
                 {},
                 "its process ended " + error.problem.substr(open, close + 1 - open),
                 "run the sweep again"};
    // A folder that does not take it is told of as the parts are joined.
    static_cast<void>(folder.fail(part, error));
    return Ending::failed;
}

}  // namespace

Result<SweepCounts> runParts(const SweepFolder& folder, const std::vector<std::size_t>& parts,
                             SweepProgress progress) {
    std::vector<const SweepPart*> missing;
    KnownHashes known;
    for (const std::size_t number : parts) {
        const SweepPart& part = folder.sweep().parts[number];
        if (!folder.done(part, known)) missing.push_back(&part);
    }
    SweepCounts counts;
    counts.kept = parts.size() - missing.size();
    if (missing.empty()) return counts;
    const std::size_t cores = std::max<std::size_t>(threadCount(), 1);
    const std::size_t workers = std::min(cores, missing.size());
    Teller teller(progress, missing.size());
    std::atomic<std::size_t> next{0};
    const auto work = [&] {
        for (std::size_t i = next++; i < missing.size(); i = next++) {
            const std::size_t together = std::min(workers, missing.size() - i);
            teller.ended(runInProcess(folder, *missing[i], std::max<std::size_t>(cores / together, 1)));
        }
    };
    std::vector<std::thread> threads;
    for (std::size_t i = 1; i < workers; ++i) threads.emplace_back(work);
    work();
    for (std::thread& thread : threads) thread.join();
    counts.done = teller.done();
    counts.failed = teller.failed();
    counts.elsewhere = teller.elsewhere();
    return counts;
}

std::string durationText(double seconds) {
    if (seconds < 90) return fmt::format("{:.0f} s", std::ceil(seconds));
    if (seconds < 5400) return fmt::format("{:.0f} min", std::ceil(seconds / 60));
    return fmt::format("{:.1f} h", seconds / 3600);
}

}  // namespace hairloom::cli
