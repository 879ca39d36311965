// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The parts of the look panel that are more than rows of fields, each in the file of its name.

#include <QWidget>

#include "editor/document/messages.h"
#include "editor/document/preferences.h"
#include "editor/document/prices.h"
#include "editor/document/qt_document.h"
#include "editor/document/tasks.h"
#include "editor/viewport/viewport.h"

namespace hairloom::editor {

/// Looks as thumbnails; a click takes one, and the document's can be kept under a name.
QWidget* makePresetList(QtDocument& document, Messages& messages, Viewport& viewport);
/// Curves and tables of the shading models, drawn anew while a control moves.
QWidget* makeShadingChart(QtDocument& document, const Preferences& preferences);
/// A look to compare with, left of a line in the viewport.
QWidget* makeCompareBar(QtDocument& document, Viewport& viewport);
/// How finely the viewport draws: edges, shadows, hair over hair; and what each setting costs where that was
/// measured.
QWidget* makePictureForm(const Preferences& preferences, const Prices& prices, Viewport& viewport);
/// A button that measures what the picture's settings cost, for this hair in this view.
QWidget* makePicturePrices(QtDocument& document, Tasks& tasks, Viewport& viewport, Prices& prices);

}  // namespace hairloom::editor
