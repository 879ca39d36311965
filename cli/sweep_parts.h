// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What is known of a sweep's parts, kept as files, so that any process on any machine goes on where another
// ended:
//
//     OUT/sweep.json               whose folder this is
//     OUT/parts/0007/              outputs of part 7
//     OUT/state/0007.json          written last and at once: it is done
//     OUT/state/0007.failed.json   why it failed last

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cli/sweep_file.h"

namespace hairloom::cli {

/// A file that a part has written.
struct PartFile {
    std::string name;  ///< in the folder of the part, with '/'
    std::uint64_t bytes = 0;
    std::string hash;  ///< XXH3, 16 digits
};

/// Hashes of inputs, kept while many parts that name the same files are looked at.
using KnownHashes = std::map<std::filesystem::path, std::string>;

/// A part that is done.
struct DonePart {
    Report report;  ///< the job's, with "{out}" for the folder of the part
    std::vector<PartFile> files;
    std::vector<std::string> warnings;
    double seconds = 0;  ///< wall clock
    std::string node;    ///< machine, where its environment tells
};

class SweepFolder {
  public:
    /// Takes the folder for the sweep, and makes it where it is missing. Errors: a folder that holds
    /// something else, or cannot be written.
    static Result<SweepFolder> open(const Sweep& sweep, std::filesystem::path folder);

    /// The part, if what it was made from and what it has written are as they were.
    std::optional<DonePart> done(const SweepPart& part, KnownHashes& known) const;
    /// Why it failed last, if it did.
    std::optional<Error> failure(const SweepPart& part) const;

    /// Does the part in this process. Errors: what the job says, which failure() then tells, too; another
    /// process that does the same part.
    Result<DonePart> run(const SweepPart& part) const;
    /// Notes why the process that did the part ended.
    Status fail(const SweepPart& part, const Error& error) const;
    void forget(const SweepPart& part) const;  ///< its failure
    /// Why no other process can do the part now: one does it.
    std::optional<Error> busy(const SweepPart& part) const;

    std::filesystem::path folderOf(const SweepPart& part) const { return folder_ / "parts" / part.name; }
    const std::filesystem::path& path() const { return folder_; }
    const Sweep& sweep() const { return *sweep_; }

  private:
    SweepFolder(const Sweep& sweep, std::filesystem::path folder)
        : sweep_(&sweep), folder_(std::move(folder)) {}
    std::filesystem::path doneFile(const SweepPart& part) const;
    std::filesystem::path failedFile(const SweepPart& part) const;
    Result<DonePart> runJob(const SweepPart& part) const;
    /// Of the program's version, the words and the files that these name.
    std::string inputHash(const SweepPart& part, KnownHashes& known) const;

    const Sweep* sweep_;
    std::filesystem::path folder_;
};

}  // namespace hairloom::cli
