// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Takes from a process that parses foreign files all that parsing does not need: the network, writing, other
// programs, other processes, and all files but those of one folder. docs/security.md says it for
// administrators.

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"

namespace hairloom {

enum class LayerState : std::uint8_t {
    Set,
    Missing,  ///< this system or kernel has no such thing, or gives it to nobody
    Failed,   ///< it is there and could not be set
};
std::string_view layerStateName(LayerState state);

/// One thing that is taken from the process, by a means of its own.
struct ConfinementLayer {
    /// "memory": a limit of address space. "processes": other processes have no number here. "paths": only
    /// the folder is there. "files": only the folder can be read, nothing written. "system_calls": few, and
    /// with few arguments. Of Windows: "memory"; "programs": no process but this one; "integrity": nothing
    /// that the user owns can be written, no process of the user touched.
    std::string name;
    LayerState state = LayerState::Missing;
    std::string why;  ///< of one that is not set
};

struct Confinement {
    std::vector<ConfinementLayer> layers;
    int landlockVersion = 0;  ///< of the kernel's interface; 0 where there is none

    bool isSet(std::string_view layer) const;
    /// Names and reasons of the layers in that state; empty where there is none.
    std::string namesOf(LayerState state) const;
};

/// From now on the process reads files in `folder` and below it only, writes to what is open as its output
/// and errors, and has at most so much memory. Cannot be taken back. It may return in a process of its own,
/// whose end the one that called it shares. Sanitizers need more memory and system calls than is left: with
/// them those layers are missing. Call it before there are threads.
Confinement confineProcess(const std::filesystem::path& folder, std::uint64_t memoryBytes);

/// From now on the process ends when the one that started it does, however that ends: nobody takes its answer
/// any more. Call it first. On Windows the parent's job sees to it (child_process.h); elsewhere nothing does.
void endWithParent();

/// One thing that a confined process must not be able to do, and whether it could.
struct ConfinementTrial {
    /// "network", "write", "other_files", "stat" (of a file outside), "programs", "signals" (to the process
    /// below), "limits" (of it), "memory" (more than the limit), "code" (memory that is executed)
    std::string what;
    bool isRefused = false;
};

/// What is there to escape to, and harmless to try.
struct ConfinementBait {
    std::filesystem::path folder;   ///< of confineProcess()
    std::filesystem::path outside;  ///< an existing file that does not lie in it
    std::int64_t process = 0;       ///< another process of the same user
    std::uint64_t memoryBytes = 0;  ///< of confineProcess()
};
/// Tries each of them.
std::vector<ConfinementTrial> tryToEscape(const ConfinementBait& bait);

}  // namespace hairloom
