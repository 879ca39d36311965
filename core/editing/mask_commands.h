// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Masks of operators that come as a whole, as an image gives them.

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/editing/stack_commands.h"

namespace hairloom::editing {

/// From 1: the first mask that no operator has and nothing is painted on. Error: there is none.
Result<std::uint32_t> freeMask(const Groom& groom);

/// The masks, from 1, that no operator has and nothing is painted on.
std::vector<std::uint32_t> freeMasks(const Groom& groom);
/// Masks for `count` regions: those from `first` on, whatever they hold, or free ones where it is 0. Error:
/// there are not as many.
Result<std::vector<std::uint32_t>> masksFor(const Groom& groom, std::size_t count, std::uint32_t first = 0);
/// One step that fills masks, each with one value in [0, 1] for each strand. `numbers` are different and as
/// many as `values`. `called` has the name that each mask takes, or none at all: those that are empty change
/// nothing, and a name that another mask has leaves it without one.
std::unique_ptr<Command> fillMasks(const Model& model, std::string name,
                                   std::span<const std::uint32_t> numbers,
                                   std::span<const std::vector<float>> values,
                                   std::span<const std::string> called = {});

/// One value in [0, 1] for each strand, as the mask of the operator at `index`: in the painted map that it
/// has, else in the first free one, which becomes its map. Null where nothing changes. Errors: no such
/// operator, no free mask.
StackCommand fillMaskOf(const Model& model, std::size_t index, std::span<const float> values);

}  // namespace hairloom::editing
