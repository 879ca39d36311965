// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Takes from a process that parses foreign files all that parsing does not need: the network, writing, other
// programs, and all files but those of one folder. On Linux by seccomp and Landlock, as far as the kernel has
// them.

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace hairloom {

/// What confineProcess() could take from the process.
struct Confinement {
    bool systemCalls = false;  ///< network, writing, starting programs: refused (seccomp)
    bool files = false;        ///< reading outside the folder: refused (Landlock)
    int landlockVersion = 0;   ///< of the kernel's interface; 0 where there is none
};

/// From now on the process reads files in `folder` and below it only, and writes to what is open as its
/// output and errors. Cannot be taken back. Sanitizers need more than seccomp leaves: with them only files
/// are refused.
Confinement confineProcess(const std::filesystem::path& folder);

/// One thing that a confined process must not be able to do, and whether it could.
struct ConfinementTrial {
    std::string what;  ///< "network", "write", "other_files", "programs"
    bool isRefused = false;
};
/// Tries each of them; outside the folder of confineProcess() `outside` is an existing file.
std::vector<ConfinementTrial> tryToEscape(const std::filesystem::path& folder,
                                          const std::filesystem::path& outside);

}  // namespace hairloom
