// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The colours of the viewport and of images made in the window: a config of OpenColorIO, its display and
// view.

#include "editor/panels/panel.h"

namespace hairloom::editor {

/// Keeps what is chosen in the preferences. Where it cannot be used, the standard colours are shown, and the
/// box and a message say why.
QWidget* makeColours(const PanelParts& parts);

}  // namespace hairloom::editor
