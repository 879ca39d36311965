// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The two looks of the program: palette and style sheet.

#include <QApplication>

#include "editor/document/preferences.h"

namespace hairloom::editor {

/// Sets style, palette and style sheet of the whole application.
void applyTheme(QApplication& application, Theme theme);

/// Colours that widgets which paint themselves need.
struct ThemeColours {
    QColor viewport, field, text, dimText, accent, good, caution, bad;
};
ThemeColours themeColours(Theme theme);

}  // namespace hairloom::editor
