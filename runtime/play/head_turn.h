// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "hairloom/strands.h"

namespace hairloom::runtime {

/// How a head has turned since rest, by all of its roots: the rotation that fits where they are best, in the
/// mean of squares (Horn 1987). Roots that lie together leave it to how they have turned themselves. Those
/// that are no numbers do not count.
Quat headTurn(std::span<const Float3> rest, std::span<const RootFrame> roots);

}  // namespace hairloom::runtime
