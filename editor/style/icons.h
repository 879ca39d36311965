// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The program's own icons: one-colour SVG drawings that take the text colour of the theme.

#include <QIcon>
#include <QString>

namespace hairloom::editor {

/// Of the files of icons: svg, or png in builds for systems without Qt's SVG plugin.
const QString& iconEnding();
/// The drawing editor/resources/icons/NAME.svg, sharp at any size; follows the palette of the application.
/// Whether there is one of that name.
bool hasIcon(const QString& name);
QIcon icon(const QString& name);

}  // namespace hairloom::editor
