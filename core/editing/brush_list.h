// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The brushes there are. A new one is a file in core/editing/brushes that defines `BrushEntry nameBrush()`,
// with the name of the file.

#include <memory>
#include <span>
#include <string_view>

#include "core/editing/brush.h"
#include "core/groom/file/fields.h"
#include "core/operations/strand_edit.h"

namespace hairloom::editing {

/// One of each file of brushes/, in order of file name (hairloom_registry).
const std::vector<BrushEntry>& brushEntries();

/// In the order of a toolbar.
std::span<const std::string_view> brushNames();
/// `name` is one of brushNames().
const BrushInfo& brushInfo(std::string_view name);
/// A brush for one stroke; null for an unknown name.
std::unique_ptr<Brush> makeBrush(std::string_view name);

/// Settings that all brushes have, but for the curves and the parameters.
std::span<const Field<BrushSettings>> fieldsOf(const BrushSettings&);

/// The tool is known, its settings are in range and its parameters are its own.
Status checkStroke(const Stroke& stroke);

}  // namespace hairloom::editing
