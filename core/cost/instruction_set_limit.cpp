// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/cost/instruction_set_limit.h"

#include <hwy/highway.h>

#include <algorithm>

namespace hairloom {

InstructionSetLimit::InstructionSetLimit(std::int64_t target) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

InstructionSetLimit::~InstructionSetLimit() {
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

std::vector<std::int64_t> InstructionSetLimit::available() {
    std::vector<std::int64_t> targets = hwy::SupportedAndGeneratedTargets();
    std::ranges::sort(targets);  // Highway numbers the better ones lower.
    return targets;
}

}  // namespace hairloom
