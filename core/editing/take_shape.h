// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <span>

#include "core/editing/command.h"

namespace hairloom::editing {

/// Hair that has moved becomes the authored shape, in one step: `positions_ss` are those of all points, in
/// the scalp's rest space. Roots stay, segments keep their lengths. Operators stay and a sculpt on top of
/// them holds the difference. With `carriesWeight` strands are rods that carry their weight in it, so that it
/// holds under gravity. Errors: another number of points, positions that are not finite, a stack that is
/// full.
Result<std::unique_ptr<Command>> takeShape(const Model& model, std::span<const Vec3f> positions_ss,
                                           bool carriesWeight);

}  // namespace hairloom::editing
