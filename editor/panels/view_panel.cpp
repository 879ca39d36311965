// SPDX-License-Identifier: GPL-3.0-or-later
// What the viewport shows besides the hair, and in which light.
#include <QCheckBox>
#include <QFormLayout>
#include <QVBoxLayout>
#include <memory>
#include <set>

#include "editor/fields/number_box.h"
#include "editor/overlays/overlay_mode.h"
#include "editor/panels/list.h"
#include "editor/panels/panel.h"
#include "editor/session.h"

namespace hairloom::editor {
namespace {

QCheckBox* check(const QString& name, const QString& title, const QString& tip, bool on) {
    auto* box = new QCheckBox(title);
    box->setObjectName(name);
    box->setToolTip(tip);
    box->setChecked(on);
    return box;
}

QWidget* makeParts(Session& session) {
    auto* widget = new QWidget;
    auto* layout = new QVBoxLayout(widget);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(5);
    auto* hair = check("hair", QObject::tr("Hair"), QObject::tr("Shows the hair"), true);
    auto* head = check("head", QObject::tr("Head"), QObject::tr("Shows the head"), true);
    QObject::connect(hair, &QCheckBox::toggled, session.viewport, &Viewport::setHairShown);
    QObject::connect(head, &QCheckBox::toggled, session.viewport, &Viewport::setHeadShown);
    layout->addWidget(hair);
    layout->addWidget(head);
    const auto shown = std::make_shared<std::set<const OverlayMode*>>();
    for (const OverlayMode& mode : overlayModes()) {
        auto* box = check(mode.id, QObject::tr(mode.title), QObject::tr(mode.tip), false);
        layout->addWidget(box);
        QObject::connect(box, &QCheckBox::toggled, session.viewport, [&session, &mode, shown](bool on) {
            on ? static_cast<void>(shown->insert(&mode)) : static_cast<void>(shown->erase(&mode));
            session.viewport->redraw();
        });
    }
    session.viewport->addMarks([&session, shown](Marks& marks) {
        for (const OverlayMode& mode : overlayModes()) {
            if (shown->contains(&mode)) mode.draw(session, marks);
        }
    });
    return widget;
}

QWidget* makeLight(Session& session) {
    auto* widget = new QWidget;
    auto* layout = new QFormLayout(widget);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setVerticalSpacing(6);
    auto* turn = new NumberBox(-180, 180, false);
    turn->setObjectName("lightTurn");
    turn->setShown(1, QStringLiteral("°"), 0);
    turn->setValue(0);
    turn->setToolTip(QObject::tr("Degrees by which the three lights are turned about the head"));
    QObject::connect(turn, &NumberBox::edited, session.viewport, [&session](double degrees) {
        session.viewport->setLightTurn(static_cast<float>(degrees));
    });
    layout->addRow(QObject::tr("Turn light"), turn);
    auto* exposure = new NumberBox(0.2, 6, false);
    exposure->setObjectName("exposure");
    exposure->setValue(1.6);
    exposure->setToolTip(QObject::tr("Factor on the brightness of the picture; 1.6 shows skin as it is"));
    QObject::connect(exposure, &NumberBox::edited, session.viewport, [&session](double factor) {
        session.viewport->setExposure(static_cast<float>(factor));
    });
    layout->addRow(QObject::tr("Exposure"), exposure);
    return widget;
}

}  // namespace

QWidget* makeViewPanel(Session& session) {
    return scrolled(column({heading(QObject::tr("Show")), makeParts(session), heading(QObject::tr("Light")),
                            makeLight(session)}));
}

}  // namespace hairloom::editor
