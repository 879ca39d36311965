// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What the writers of this process may replace. A folder, a link that somebody else laid in a folder for all,
// and a file that another writer is writing are refused whatever the rules say.

#include <filesystem>
#include <string>

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

/// Set once, before anything is read or written.
void setWriteRules(WriteRules rules);
const WriteRules& writeRules();

/// The process reads this file. readFile() and readTextFile() say so themselves.
void noteInput(const std::filesystem::path& path);

}  // namespace hairloom
