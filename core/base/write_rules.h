// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What the writers of this process may replace. A folder, a link that somebody else laid in a folder for all,
// and a file that another writer is writing are refused whatever the rules say.

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/file_version.h"
#include "core/base/result.h"

namespace hairloom {

struct WriteRules {
    /// Replaces a read-only file, one of another kind and one that was read, and writes through a device or a
    /// FIFO.
    bool force = false;
    /// Refuses to replace a file that this process has read (a project by a project aside), and one that
    /// somebody has changed since.
    bool keepInputs = false;
    /// What errors say to do instead.
    std::string instead = "give another name";
};

/// Set before anything is read or written; forgets what was.
void setWriteRules(WriteRules rules);
const WriteRules& writeRules();

/// The process reads this file. readFile() and readTextFile() say so themselves. What it was when it was read
/// first counts.
void noteInput(const std::filesystem::path& path);
/// The same of a file that was read as `version` once, whatever it is now.
void noteInput(const std::filesystem::path& path, const FileVersion& version);
/// It is read anew, or may be replaced whoever has changed it.
void forgetInput(const std::filesystem::path& path);

/// The file as this process has read or written it last; one that does not exist where it has not, or where
/// inputs are not kept.
FileVersion knownVersion(const std::filesystem::path& path);
/// Somebody else has changed or replaced the file since this process read or wrote it. False where the file
/// is gone.
bool isChangedByOthers(const std::filesystem::path& path);

/// The files that this process has read and that it has not written since, by names without links, in order.
std::vector<std::filesystem::path> notedInputs();

/// Names that begin with this one are for this process alone: it replaces nothing that has one, whatever the
/// rules say, unless it has written that itself. Rules must keep inputs. Until setWriteRules().
void keepNew(const std::filesystem::path& beginning);

/// Bytes written to this name may go through a FIFO, or, for "-", to standard output.
void allowPipe(const std::filesystem::path& path);
bool isPipeAllowed(const std::filesystem::path& path);

}  // namespace hairloom
