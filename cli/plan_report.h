// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cli/job.h"
#include "core/render/plan.h"

namespace hairloom::cli {

/// {"passes", "targets", "buffers", "tables", "bytes"}, with the reasons for each.
Report planReport(const render::RenderPlan& plan);

}  // namespace hairloom::cli
