// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What the Accuracy panel measures.

#include "core/accuracy/work_precision.h"
#include "editor/document/tasks.h"

namespace hairloom::editor {

/// Substeps, corrections of length and points around those of the groom, beside the reference, in half a
/// minute or so. `partial` gets what is known after each round, on the thread of the work. Errors: those of
/// measureWorkPrecision().
Result<WorkPrecision> measureGrid(const Groom& groom, const HeadMotion& motion, TaskControl& control,
                                  const std::function<void(const WorkPrecision&)>& partial);

}  // namespace hairloom::editor
