// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The one way in which files are written. Content goes into a temporary file of a random name in the folder
// of the target; finish() puts it in place when it is whole and on the disk. Readers see the old content or
// the new.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/result.h"

namespace hairloom {

enum class Replacing : std::uint8_t {
    SameKind,  ///< what setWriteRules() allows
    Anything,  ///< a file of the program's own, as in a cache
};

/// A file that is being written. Symbolic links are followed; mode, owner, access lists and time of access of
/// a file that is replaced are kept. One with further hard links, or with an owner that the process cannot
/// give, is written in place once the new content is on the disk beside it. Content equal to what is there
/// touches nothing.
class OutputFile {
  public:
    /// Errors: what WriteRules refuse (`kind`, one of content's, is held against what is there when it is
    /// given), another writer of the same file, a folder that cannot be written.
    static Result<OutputFile> open(const std::filesystem::path& path, std::string_view kind = {},
                                   Replacing replacing = Replacing::SameKind);
    OutputFile(OutputFile&&) noexcept;
    OutputFile& operator=(OutputFile&&) noexcept;
    /// Unfinished, it leaves what was there.
    ~OutputFile();

    Status write(std::span<const std::byte> bytes);
    /// Over what was written.
    Status writeAt(std::uint64_t offset, std::span<const std::byte> bytes);
    /// What was written stays as a left-over where it is not finished, whatever ends the process: half of it
    /// is worth something. Not of a device.
    void keepUnfinished();
    /// Flushes file and folder to the disk and puts the content in place. Errors: as for open(), checked
    /// again.
    Status finish();

    /// What open() would refuse by the rules; nothing is made.
    static Status check(const std::filesystem::path& path, std::string_view kind = {});
    /// Errors: the disk takes nothing. What is tried is no content: such a file is not to be finished.
    Status tryOut();

  private:
    struct Impl;
    explicit OutputFile(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

/// All at once, as OutputFile does. On error nothing is left under either name.
Status writeFileAtomically(const std::filesystem::path& path, std::span<const std::byte> bytes,
                           Replacing replacing = Replacing::SameKind);
Status writeFileAtomically(const std::filesystem::path& path, std::string_view text);

/// Makes the folder where it is missing and writes texts under names in it, each as writeFileAtomically()
/// does: all of them or none. The names, in order.
Result<std::vector<std::string>> writeFiles(const std::filesystem::path& folder,
                                            const std::vector<std::pair<std::string, std::string>>& files);

/// From now on SIGINT, SIGTERM and SIGHUP (on Windows the console's close and Ctrl+C) take temporary files
/// away before they end the process.
void removeTemporariesWhenEnded();
/// Likewise these folders, where they are empty then; the innermost first. Until it is called again.
void removeFoldersWhenEnded(const std::vector<std::filesystem::path>& innermostFirst);

/// A temporary file whose writer was killed.
struct LeftOver {
    std::filesystem::path file;
    std::string target;       ///< name of the file that it was to become, as far as the name tells
    std::uint64_t bytes = 0;  ///< of content
    /// The target is being written in place and may be torn: the left-over has all of its new content.
    bool whole = false;
};
/// Those in a folder, in order of name; none where it cannot be read. Files that are being written are not
/// among them.
std::vector<LeftOver> findLeftOvers(const std::filesystem::path& folder);
/// Errors: somebody writes it again, or it cannot be removed.
Status removeLeftOver(const LeftOver& leftOver);

}  // namespace hairloom
