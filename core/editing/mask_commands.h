// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Masks of operators that come as a whole, as an image gives them.

#include <cstdint>
#include <span>

#include "core/editing/stack_commands.h"

namespace hairloom::editing {

/// From 1: the first mask that no operator has and nothing is painted on. Error: there is none.
Result<std::uint32_t> freeMask(const Groom& groom);

/// One value in [0, 1] for each strand, as the mask of the operator at `index`: in the painted map that it
/// has, else in the first free one, which becomes its map. Null where nothing changes. Errors: no such
/// operator, no free mask.
StackCommand fillMaskOf(const Model& model, std::size_t index, std::span<const float> values);

}  // namespace hairloom::editing
