// SPDX-License-Identifier: GPL-3.0-or-later
#include <QObject>

#include "editor/panels/list.h"
#include "editor/panels/panel.h"

namespace hairloom::editor {

const std::vector<PanelInfo>& panels() {
    static const std::vector<PanelInfo> all{
        {"tool", QObject::tr("Tool"), "brush", Qt::LeftDockWidgetArea, true, makeToolPanel},
        {"scalp", QObject::tr("Scalp"), "paint-scalp", Qt::LeftDockWidgetArea, true, makeScalpPanel},
        {"view", QObject::tr("View"), "overlay", Qt::LeftDockWidgetArea, true, makeViewPanel},
        {"history", QObject::tr("History"), "history", Qt::LeftDockWidgetArea, true, makeHistoryPanel},
        {"look", QObject::tr("Look"), "look", Qt::RightDockWidgetArea, true, makeLookPanel},
        {"physics", QObject::tr("Physics"), "physics", Qt::RightDockWidgetArea, true, makePhysicsPanel},
        {"motion", QObject::tr("Motion"), "play", Qt::RightDockWidgetArea, true, makeMotionPanel},
        {"spheres", QObject::tr("Spheres"), "sphere", Qt::RightDockWidgetArea, true, makeSpheresPanel},
        {"effects", QObject::tr("Effects"), "effects", Qt::RightDockWidgetArea, true, makeEffectsPanel},
    };
    return all;
}

}  // namespace hairloom::editor
