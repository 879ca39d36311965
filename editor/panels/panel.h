// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A dockable panel. Each is a file of its own, panels/NAME_panel.cpp, with one function `PanelInfo
// namePanel()`; the list is made from the names of the files.

#include <QString>
#include <QWidget>
#include <functional>
#include <vector>

#include "editor/document/messages.h"
#include "editor/document/preferences.h"
#include "editor/document/prices.h"
#include "editor/document/qt_document.h"
#include "editor/document/tasks.h"
#include "editor/fields/blocks.h"
#include "editor/simulation/keying.h"
#include "editor/simulation/player.h"
#include "editor/style/actions.h"
#include "editor/tools/tool_box.h"
#include "editor/viewport/viewport.h"

namespace hairloom::editor {

/// What panels are made with; each hands on what its widgets use.
struct PanelParts {
    QtDocument& document;
    Preferences& preferences;
    Prices& prices;
    Tasks& tasks;
    Messages& messages;
    Player& player;
    Keying& keying;
    Viewport& viewport;
    ToolBox& tools;
    Actions& actions;
};

struct PanelInfo {
    QString id;  ///< layouts are saved under it
    QString title;
    QString icon;
    Qt::DockWidgetArea area = Qt::RightDockWidgetArea;
    int order = 100;   ///< from the first tab of its area on
    bool open = true;  ///< in the first layout
    std::function<QWidget*(const PanelParts&)> make;
};

/// In order of file name (hairloom_registry).
const std::vector<PanelInfo>& panelFiles();
/// By their order.
const std::vector<PanelInfo>& panels();

}  // namespace hairloom::editor
