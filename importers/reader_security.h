// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What foreign files are read in, and what that process cannot do.

#include <string>
#include <utility>
#include <vector>

#include "core/base/result.h"

namespace hairloom {

/// As the mesh reader finds them by trying: "seccomp", "landlock", "landlock_version"; "layer_NAME" for each
/// ConfinementLayer, set, missing or failed; "refuses_NAME" for each ConfinementTrial. Errors: the reader
/// cannot be run.
Result<std::vector<std::pair<std::string, std::string>>> readerSecurity();

/// Reads foreign files also where a layer that this system has cannot be set. Set before anything is read.
void allowUnconfinedReaders(bool allowed);
bool areUnconfinedReadersAllowed();

}  // namespace hairloom
