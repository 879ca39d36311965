// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What people are told where hair does not meet the skin collider that its groom has.

#include <string>
#include <vector>

#include "cli/job.h"
#include "core/simulation/motion.h"

namespace hairloom::cli {

/// Why hair that moves from `start` on passes through the groom's body; empty where it does not, and where
/// there is none. `strandEngine`: it is what simulates.
std::vector<std::string> bodyNotes(const Groom& groom, const HeadPose& start, bool strandEngine);

/// The same of hair that a record moves, by the pose of its frames.
std::vector<std::string> recordNotes(const Groom& groom, const HeadPose& pose);

/// Warns of them and reports them as `notes`, where there are any.
void reportNotes(const std::vector<std::string>& notes, Report& report);

}  // namespace hairloom::cli
