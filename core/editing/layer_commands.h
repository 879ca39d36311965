// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Commands over layers beside setLayers(): what is on them. Null where nothing would change.

#include <memory>
#include <span>

#include "core/base/result.h"
#include "core/editing/command.h"

namespace hairloom::editing {

/// `strands`: ascending. Operators run again, for they may be of one layer. Errors: no such layer, an
/// operator that cannot work.
Result<std::unique_ptr<Command>> moveToLayer(const Model& model, std::span<const std::uint32_t> strands,
                                             std::uint32_t layer);
/// Its strands go to the first of the others. Errors: no such layer, the only one, one that an operator is
/// of.
Result<std::unique_ptr<Command>> removeLayer(const Model& model, std::uint32_t layer);

}  // namespace hairloom::editing
