// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Whether other programs take the processors while this one measures.

#include <cstdint>
#include <optional>

namespace hairloom {

class ProcessorWatch {
  public:
    /// Begins to watch.
    ProcessorWatch();

    /// Share of all processors' time, 0…1, that other processes have used since then. Absent where the system
    /// does not tell (it is read from Linux' /proc/stat, which counts in steps of 10 ms) and before 0.2 s
    /// have passed.
    std::optional<double> othersShare() const;

  private:
    struct Times {
        double busy = 0, all = 0, own = 0;  ///< seconds, of all processors
    };
    static std::optional<Times> now();

    std::optional<Times> begin_;
};

/// From here on times that were measured say little about a machine at rest.
constexpr double kBusyShare = 0.2;

}  // namespace hairloom
