// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Work of the core as a task of the window: it shows how far it is, and ends where it is cancelled.

#include "core/base/work_watch.h"
#include "editor/document/tasks.h"

namespace hairloom::editor {

/// For work that does not outlive `control`.
inline WorkWatch watchOf(TaskControl& control) {
    return {[&control](double share) { control.setProgress(static_cast<float>(share)); },
            control.cancelFlag()};
}

}  // namespace hairloom::editor
