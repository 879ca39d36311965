// SPDX-License-Identifier: GPL-3.0-or-later
#include <QObject>

#include "editor/panels/list.h"
#include "editor/panels/panel.h"

namespace hairloom::editor {

const std::vector<PanelInfo>& panels() {
    static const std::vector<PanelInfo> all{
        {"look", QObject::tr("Look"), "look", Qt::RightDockWidgetArea, true, makeLookPanel},
        {"physics", QObject::tr("Physics"), "physics", Qt::RightDockWidgetArea, true, makePhysicsPanel},
        {"view", QObject::tr("View"), "overlay", Qt::LeftDockWidgetArea, true, makeViewPanel},
        {"history", QObject::tr("History"), "history", Qt::LeftDockWidgetArea, true, makeHistoryPanel},
    };
    return all;
}

}  // namespace hairloom::editor
