// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The brushes there are. A new one is a file in core/editing/brushes and a line here and in brush_list.cpp.

#include <memory>
#include <span>
#include <string_view>

#include "core/editing/brush.h"
#include "core/groom/file/fields.h"
#include "core/operations/strand_edit.h"

namespace hairloom::editing {

std::unique_ptr<Brush> makeComb();
std::unique_ptr<Brush> makeBrushAlong();
std::unique_ptr<Brush> makeGrab();
std::unique_ptr<Brush> makeDelete();
std::unique_ptr<Brush> makeCut();
std::unique_ptr<Brush> makeCutLine();
std::unique_ptr<Brush> makeLength();
std::unique_ptr<Brush> makeSmooth();
std::unique_ptr<Brush> makePuff();
std::unique_ptr<Brush> makePinch();
std::unique_ptr<Brush> makeFreeze();
std::unique_ptr<Brush> makeAdd();
std::unique_ptr<Brush> makeScalpPaint();
std::unique_ptr<Brush> makeDensityPaint();
std::unique_ptr<Brush> makeDyePaint();

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
