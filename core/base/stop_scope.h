// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How long work on one thread hears that nobody wants it any more, however deep in it the waiting is: the
// process that reads a foreign file is started by functions that many others call.

#include <atomic>

#include "core/base/result.h"

namespace hairloom {

/// While it lives, checkStop() on this thread looks at a flag, which any thread may set. The innermost scope
/// counts.
class StopScope {
  public:
    /// `stop` outlives the scope.
    explicit StopScope(const std::atomic<bool>& stop);
    StopScope(const StopScope&) = delete;
    StopScope& operator=(const StopScope&) = delete;
    ~StopScope();

  private:
    const std::atomic<bool>* outer_;
};

/// Error: the flag of this thread's scope is set. Without a scope there is none.
Status checkStop();

}  // namespace hairloom
