// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A hairstyle onto the head of a file, as a person does it and as a script repeats it.

#include <string>

#include "core/operations/script.h"
#include "core/operations/transfer.h"

namespace hairloom {

/// Puts the groom onto the head of the file, which becomes its character. `metresPerUnit` 0: as the file
/// states. Errors: those of importScene() and transferTo().
Result<Transfer> transferToFile(Groom& groom, const std::string& path, float metresPerUnit = 0);

/// The operation "transfer" of a script (JSON) that does it. It holds the file's absolute path, not the file.
std::string transferRecord(const std::string& path, float metresPerUnit);
ScriptExtension transferExtension();

}  // namespace hairloom
