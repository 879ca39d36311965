// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What the two systems' ways to run a child process have in common: when to give up on it.

#include <functional>

#include "importers/child_process.h"

namespace hairloom {

/// How long to wait for output or the end before looking at the limits again. Memory is looked at this often;
/// a child can take about 100 MiB in between.
inline constexpr std::chrono::milliseconds kWatchInterval{20};

/// Watches one child until it ends or goes over a limit.
class ChildWatch {
  public:
    /// `residentBytes`: memory of the child that is in use; 0 where the system does not tell.
    ChildWatch(std::string name, const ChildLimits& limits, std::function<std::uint64_t()> residentBytes);

    /// Errors: a limit is exceeded, checkStop() says so, `outputBytes` being what the child has written so
    /// far.
    Status check(std::size_t outputBytes);

  private:
    using Clock = std::chrono::steady_clock;
    Status over(const std::string& what) const;

    std::string name_;
    ChildLimits limits_;
    std::function<std::uint64_t()> residentBytes_;
    Clock::time_point start_;
    Clock::time_point nextLook_;
};

/// Reserves what output that starts with its length says it will be.
void makeRoom(const ChildLimits& limits, std::vector<std::byte>& output);

/// "the mesh reader crashed on this file (signal 11, Segmentation fault)" with `how` in brackets.
Status crashed(const std::string& name, const std::string& how);
/// For an exit status other than 0.
Status gaveUp(const std::string& name, int status);
/// "cannot be started: `why`".
tl::unexpected<Error> notStarted(const std::string& name, const std::filesystem::path& program,
                                 const std::string& why);

}  // namespace hairloom
