// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How whoever started long work sees how far it is, and stops it.

#include <atomic>
#include <functional>

#include "core/base/result.h"

namespace hairloom {

/// Both may be missing. Work that is stopped fails, and leaves things as they were.
struct WorkWatch {
    std::function<void(double)> progress{};        ///< told the share that is done, 0 … 1, ascending
    const std::atomic<bool>* cancelled = nullptr;  ///< set from any thread

    bool isCancelled() const { return cancelled != nullptr && *cancelled; }
    /// Tells the share. Error: stopped.
    Status at(double share) const {
        if (isCancelled()) return fail("stopped before it was done");
        if (progress) progress(share);
        return {};
    }
    /// Of a part of the work, from one share to another.
    WorkWatch part(double from, double to) const {
        WorkWatch watch{{}, cancelled};
        if (progress)
            watch.progress = [whole = progress, from, to](double share) {
                whole(from + share * (to - from));
            };
        return watch;
    }
};

}  // namespace hairloom
