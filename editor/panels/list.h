// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The functions that make the panels, each in the file of its panel.

#include <QWidget>

namespace hairloom::editor {

class Session;

QWidget* makeToolPanel(Session& session);
QWidget* makeScalpPanel(Session& session);
QWidget* makeSpheresPanel(Session& session);
QWidget* makeMotionPanel(Session& session);
QWidget* makeEffectsPanel(Session& session);
QWidget* makeLookPanel(Session& session);
QWidget* makePhysicsPanel(Session& session);
QWidget* makeViewPanel(Session& session);
QWidget* makeHistoryPanel(Session& session);

}  // namespace hairloom::editor
