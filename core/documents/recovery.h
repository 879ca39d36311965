// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The folder in which windows keep copies of unsaved work, and by which they know of each other.
//
// A window has three files there: ID.window, held while it runs; ID.json, what it has open; ID.hairloom, its
// copy of what is unsaved.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/file_version.h"
#include "core/base/held_file.h"

namespace hairloom {

/// Where the user's data of programs lie; empty where the system tells no such place. Need not exist.
std::filesystem::path recoveryFolder();

/// What a window has open.
struct OpenDocument {
    std::filesystem::path project;  ///< absolute; empty where it was never saved
    std::string name;               ///< for people
    FileVersion base;               ///< the project's file as the window read or wrote it last
    std::int64_t process = 0;
};

/// A window's place in the folder, for as long as the window lives.
class RecoveryPlace {
  public:
    /// Errors: the folder or files in it cannot be made.
    static Result<RecoveryPlace> take();
    RecoveryPlace(RecoveryPlace&&) noexcept = default;
    RecoveryPlace& operator=(RecoveryPlace&&) noexcept = default;
    /// Takes the window's files away, the copy only where keepCopy() was not called.
    ~RecoveryPlace();

    /// The name of the copy, which need not exist.
    std::filesystem::path copy() const { return fileOf(".hairloom"); }
    /// Whether its files are where they were made.
    bool isThere() const;
    Status describe(const OpenDocument& document) const;
    void removeCopy();
    void keepCopy() { keepsCopy_ = true; }
    /// Other windows that run and have this project open.
    std::vector<OpenDocument> othersWith(const std::filesystem::path& project) const;

  private:
    RecoveryPlace(std::filesystem::path stem, HeldFile held);
    std::filesystem::path fileOf(const char* suffix) const;

    std::filesystem::path stem_;
    std::optional<HeldFile> held_;
    bool keepsCopy_ = false;
};

/// Unsaved work of a window that no longer runs.
struct RecoveryCopy {
    std::filesystem::path file;
    OpenDocument of;
    std::filesystem::file_time_type when;
    std::uint64_t bytes = 0;
    /// The project was saved after the copy was made: by the window itself, or by another program.
    bool isOlder = false;
    /// The project is not what the window had read or written last.
    bool isProjectChanged = false;
};
/// Whether both names lead to one project, which need not exist.
bool isSameProject(const std::filesystem::path& a, const std::filesystem::path& b);

/// All of them, the newest first. Takes away what windows that no longer run left beside copies, or without
/// one.
std::vector<RecoveryCopy> recoveryCopies();
/// Errors: it cannot be removed.
Status removeRecoveryCopy(const RecoveryCopy& copy);

}  // namespace hairloom
