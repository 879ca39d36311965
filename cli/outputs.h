// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The files that a job writes, kept for it from its beginning: what must not be replaced is refused before
// anything is computed, and a second job that writes the same file is told. Of several files all come, or
// none.

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <string>
#include <string_view>

#include "cli/job.h"

namespace hairloom::cli {

enum class ReadBack : std::uint8_t {
    No,   ///< a pipe will do where it is the only output: a FIFO, or "-" for standard output
    Yes,  ///< the job reads what it has written, at once
};

struct Output {
    const std::string& path;     ///< no file where it is empty
    std::string_view kind = {};  ///< one of hairloom::content, where the job knows it
};

/// Errors: as OutputFile::open() for any of them, before `run` is called. Throws WrongUsage for a pipe where
/// none will do.
Result<Report> withOutputs(std::initializer_list<Output> outputs, const std::function<Result<Report>()>& run,
                           ReadBack readBack = ReadBack::No);

/// A folder that gets several files. Made where it is missing, and taken away again, empty, where the job
/// fails. No folder where the name is empty.
Result<Report> withOutputFolder(const std::string& folder, const std::function<Result<Report>()>& run,
                                ReadBack readBack = ReadBack::No);

/// The job writes its file to standard output, so that its report goes to standard error.
bool writesToStandardOutput();

/// Called before a job runs: --json prints to standard output, too.
void reportsAsJson(bool json);

}  // namespace hairloom::cli
