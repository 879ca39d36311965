// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The functions that make the panels, each in the file of its panel.

#include <QWidget>

namespace hairloom::editor {

class Session;

QWidget* makeLookPanel(Session& session);
QWidget* makePhysicsPanel(Session& session);
QWidget* makeViewPanel(Session& session);
QWidget* makeHistoryPanel(Session& session);

}  // namespace hairloom::editor
