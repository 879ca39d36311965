// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The parts of the look panel that are more than rows of fields, each in the file of its name.

#include <QWidget>

namespace hairloom::editor {

class Session;

/// Looks as thumbnails; a click takes one, and the document's can be kept under a name.
QWidget* makePresetList(Session& session);
/// A look to compare with, left of a line in the viewport.
QWidget* makeCompareBar(Session& session);
/// How finely the viewport draws: edges, shadows, hair over hair.
QWidget* makePictureForm(Session& session);

}  // namespace hairloom::editor
