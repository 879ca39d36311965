// SPDX-License-Identifier: MIT
#pragma once
// How much detail each character of a crowd is worth: hl_crowd_plan.

#include <span>

#include "play/instance.h"

namespace hairloom::runtime {

/// Nothing is changed where it refuses.
Outcome planCrowd(const hl_crowd_limits& limits, std::span<hl_viewed> characters, hl_crowd_report& report);

}  // namespace hairloom::runtime
