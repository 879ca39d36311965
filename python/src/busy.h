// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Objects that one thread uses at a time, although long calls let go of the GIL.

#include <atomic>

#include "python/src/errors.h"

namespace hairloom::python {

/// Taken for as long as it lives. Throws hairloom.BusyError where another thread has it.
class Use {
  public:
    Use(std::atomic<bool>& inUse, const char* what) : inUse_(inUse) {
        if (inUse_.exchange(true)) raiseBusy(what);
    }
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;
    ~Use() { inUse_ = false; }

  private:
    std::atomic<bool>& inUse_;
};

/// What `work` gives, done without the GIL. It touches nothing of Python.
template <class Work>
auto withoutGil(const Work& work) {
    nb::gil_scoped_release released;
    return work();
}

}  // namespace hairloom::python
