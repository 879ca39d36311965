// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Colours of documents are linear RGB; colours of the screen are sRGB.

#include <QColor>

#include "core/base/math.h"

namespace hairloom::editor {

/// Components outside 0 … 1 are clamped.
QColor fromLinear(const Vec3f& linear);
Vec3f toLinear(const QColor& colour);

}  // namespace hairloom::editor
