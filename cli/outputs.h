// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The files that a job writes, kept for it from its beginning: what must not be replaced is refused before
// anything is computed, and a second job that writes the same file is told. Of several files all come, or
// none.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/job.h"

namespace hairloom::cli {

enum class ReadBack : std::uint8_t {
    No,   ///< a pipe will do where it is the only output: a FIFO, or "-" for standard output
    Yes,  ///< the job reads what it has written, at once
};

struct Output {
    std::string path;            ///< no file where it is empty
    std::string_view kind = {};  ///< one of hairloom::content, where the job knows it
    std::size_t files = 0;       ///< of a sequence, whose names are numbered; 0 where there is none
    std::size_t first = 0;       ///< number of the sequence's first file
};

/// Errors: as OutputFile::open() for any of them, before `run` is called. Throws WrongUsage for a pipe where
/// none will do.
Result<Report> withOutputs(const std::vector<Output>& outputs, const std::function<Result<Report>()>& run,
                           ReadBack readBack = ReadBack::No);

/// A folder that gets several files, of which `files` are known before the work. Made where it is missing,
/// and taken away again, empty, where the job fails or is ended. No folder where the name is empty.
Result<Report> withOutputFolder(const std::string& folder, const std::vector<std::string>& files,
                                const std::function<Result<Report>()>& run);

/// Throws WrongUsage for "-" in place of a folder: for jobs that keep theirs otherwise than
/// withOutputFolder().
void refusePipeForFolder(const std::string& folder);

/// Called before a job runs: beside its outputs it writes a manifest (core/groom/file/manifest.h),
/// F.manifest.json for a first output F, or manifest.json in a folder. The text is the program's command
/// line.
void writeManifest(const std::string& commandLine);

/// The job writes its file to standard output, so that its report goes to standard error.
bool writesToStandardOutput();

/// Called before a job runs: --json prints to standard output, too.
void reportsAsJson(bool json);
/// People read the report otherwise: long lists of numbers stay out.
bool isReportJson();

}  // namespace hairloom::cli
