// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What output_file.cpp needs of the system: the state of a name, and a temporary file that takes its place.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "core/base/file_version.h"
#include "core/base/result.h"

namespace hairloom {

inline constexpr std::string_view kFifo = "a FIFO";

/// What a name stands for; links are followed.
struct FileState : FileVersion {
    bool folder = false;
    std::string_view device;  ///< "a device", kFifo, "a socket", or empty
    bool readOnly = false;
    std::int64_t accessed = 0;  ///< time of the last access
};
FileState fileState(const std::filesystem::path& path);

/// The name behind symbolic links, which need not exist. Errors: a circle, a link in a folder for all that
/// somebody else laid there.
Result<std::filesystem::path> followLinks(const std::filesystem::path& path);

/// ".NAME.RANDOM.hairloom-part", or "….hairloom-whole" while the target is written in place.
inline constexpr std::string_view kPartSuffix = ".hairloom-part";
inline constexpr std::string_view kWholeSuffix = ".hairloom-whole";

/// Its file is open, locked against findLeftOvers() and known to the handler of signals, until it is gone.
class TemporaryFile {
  public:
    /// In the folder of `target`, a name without links. Errors: another process writes the same target.
    static Result<TemporaryFile> create(const std::filesystem::path& target);
    TemporaryFile(TemporaryFile&&) noexcept;
    TemporaryFile& operator=(TemporaryFile&&) noexcept;
    /// Takes the file away, unless it has taken the target's place.
    ~TemporaryFile();

    Status write(std::span<const std::byte> bytes);
    Status writeAt(std::uint64_t offset, std::span<const std::byte> bytes);
    /// Onto the disk: that it is full shows here, at the latest.
    Status flush();
    /// Stays as a left-over where it does not take the target's place, also when the process is ended.
    void setKept(bool isKept);
    /// Where its content lies now.
    std::filesystem::path path() const;
    /// Whether the target has the same bytes.
    bool equalsTarget() const;
    /// Takes the target's place, which exists or not. A file that is replaced was last accessed at
    /// `accessed`. `isOldKept`: what was there stays beside it until this object goes, for putBack().
    Status replaceTarget(std::int64_t accessed, bool isOldKept = false);
    /// After replaceTarget() with the old kept, also where it failed: the target is as it was before. Errors:
    /// it cannot be; then the old content stays, and the error names its file.
    Status putBack();

  private:
    struct Impl;
    explicit TemporaryFile(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

/// Straight into a device or FIFO, all at once; "-" is standard output.
Status writeThrough(const std::filesystem::path& path, std::span<const std::byte> bytes);

/// As many files open at once as the system lets the process have.
void allowManyFiles();

/// While one lives, a signal that ends the process waits: what is moved into place is all moved.
class EndsLater {
  public:
    EndsLater();
    EndsLater(const EndsLater&) = delete;
    EndsLater& operator=(const EndsLater&) = delete;
    ~EndsLater();
};

/// Whether a process has the file open for writing as TemporaryFile does.
bool isBeingWritten(const std::filesystem::path& temporary);

}  // namespace hairloom
