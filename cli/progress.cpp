// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#ifdef _WIN32
#include <io.h>
#else
#include <unistd.h>
#endif

namespace hairloom::cli {
namespace {

constexpr int kCells = 32;

bool standardErrorIsTerminal() {
#ifdef _WIN32
    return _isatty(_fileno(stderr)) != 0;
#else
    return isatty(fileno(stderr)) != 0;
#endif
}

}  // namespace

Progress::Progress(std::string what, std::size_t total)
    : what_(std::move(what)), total_(std::max<std::size_t>(total, 1)), shown_(standardErrorIsTerminal()) {
    done(0);
}

Progress::~Progress() {
    if (shown_) fmt::print(stderr, "\r\x1b[K");
}

void Progress::done(std::size_t count, const std::string& note) {
    if (!shown_) return;
    const int filled = static_cast<int>(std::min(count, total_) * kCells / total_);
    if (filled == drawn_ && note == note_) return;
    drawn_ = filled;
    note_ = note;
    fmt::print(stderr, "\r{} [{:#<{}}{: <{}}] {}/{}{}{}", what_, "", filled, "", kCells - filled, count,
               total_, note, note.empty() ? "" : "\x1b[K");
    std::fflush(stderr);
}

}  // namespace hairloom::cli
