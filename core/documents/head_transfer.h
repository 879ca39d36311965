// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A hairstyle onto the head of a file, as a person does it and as a script repeats it.

#include <string>

#include "core/documents/head_import.h"
#include "core/operations/script.h"
#include "core/operations/transfer.h"

namespace hairloom {

struct FileTransfer {
    Transfer transfer;
    HeadImportOptions taken;         ///< with what was guessed
    std::vector<std::string> words;  ///< what was guessed, and how to have it otherwise
};

/// Puts the groom onto the head of the file, which becomes its character unless it is turned. What is guessed
/// goes to the log. Errors, which leave the groom as it was: those of importHead() and transferTo(), heads
/// that are none of one size.
Result<FileTransfer> transferToFile(Groom& groom, const std::string& path, const HeadImportOptions& options,
                                    const WorkWatch& watch = {});

/// The operation "transfer" of a script (JSON) that does it. It holds the file's absolute path, not the file.
std::string transferRecord(const std::string& path, const HeadImportOptions& taken);
ScriptExtension transferExtension();

}  // namespace hairloom
