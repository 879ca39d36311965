// SPDX-License-Identifier: GPL-3.0-or-later
// How the hair moves: presets of measured hair, and all settings of the engine. A change shows in the running
// simulation at once.
#include <QComboBox>
#include <QPushButton>
#include <QVBoxLayout>

#include "core/editing/document.h"
#include "core/editing/settings_commands.h"
#include "core/scene/hair_preset.h"
#include "core/simulation/sag.h"
#include "editor/fields/field_form.h"
#include "editor/fields/stiffness_curve.h"
#include "editor/panels/panel.h"

namespace hairloom::editor {
namespace {

struct Group {
    QString title;
    QStringList fields;
    bool open;
};

std::vector<Group> groups() {
    return {
        {QObject::tr("Strands"),
         {"strandModel", "angularStiffness", "torsionRatio", "sectionRatio", "bendDampingTime",
          "restGravity"},
         true},
        {QObject::tr("Time"),
         {"substeps", "dampingTime", "teleportDistance", "sleepSpeed", "sleepDelay"},
         true},
        {QObject::tr("Wind and gravity"),
         {"windSpeed", "windKind", "windDirection", "windGustiness", "windFrequency", "windGustSize",
          "windSeed", "airDrag", "gravity"},
         true},
        {QObject::tr("Collision"),
         {"collisionRadiusRoot", "collisionRadiusTip", "friction", "restitution"},
         false},
        {QObject::tr("Springs only"),
         {"integrator", "angularMethod", "lengthMethod", "lengthIterations", "maximalExtension",
          "springFrequency", "collisionResponse", "penaltyFrequency"},
         false},
    };
}

QWidget* makePresets(QtDocument& document) {
    auto* row = new QWidget;
    auto* layout = new QVBoxLayout(row);
    layout->setContentsMargins(0, 0, 0, 0);
    auto* box = new QComboBox;
    box->setObjectName("preset");
    box->setToolTip(
        QObject::tr("Stiffness, cross-section and colour of measured hair; settings of motion stay"));
    box->addItem(QObject::tr("Preset of measured hair…"));
    for (const runtime::HairPreset& preset : runtime::presets()) {
        box->addItem(labelOf(preset.name));
        box->setItemData(box->count() - 1, QString::fromUtf8(preset.description), Qt::ToolTipRole);
    }
    QObject::connect(box, &QComboBox::activated, box, [&document, box](int index) {
        if (index == 0) return;
        const runtime::HairPreset& preset = runtime::presets()[static_cast<std::size_t>(index - 1)];
        Groom groom = document.groom();
        applyPreset(preset, groom);
        const QString step = QObject::tr("Preset %1").arg(box->itemText(index));
        document.perform(editing::setSettings(document.editing().model(), groom, step.toStdString()));
        box->setCurrentIndex(0);
    });
    layout->addWidget(box);
    return row;
}

QWidget* makeHoldButton(QtDocument& document) {
    auto* button = new QPushButton(QObject::tr("Hold this shape under gravity"));
    button->setObjectName("hold-shape");
    button->setToolTip(QObject::tr(
        "Makes strands rods whose rest shape carries their weight: the hair hangs as it is drawn"));
    QObject::connect(button, &QPushButton::clicked, button, [&document] {
        document.perform(editing::setPhysics(document.editing().model(),
                                             holdingItsShape(document.groom()).simulation,
                                             QObject::tr("Hold shape under gravity").toStdString()));
    });
    return button;
}

QWidget* withCurve(QtDocument& document, QWidget* form) {
    auto* widget = new QWidget;
    auto* layout = new QVBoxLayout(widget);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(6);
    layout->addWidget(new StiffnessCurve(document));
    layout->addWidget(form);
    return widget;
}

QWidget* makePanel(QtDocument& document, const Preferences& preferences, const Prices& prices) {
    const std::vector<Field> fields = simulationFields();
    QWidget* const content = column({makePresets(document), makeHoldButton(document)});
    auto* layout = static_cast<QVBoxLayout*>(content->layout());
    QStringList shown;
    for (const Group& group : groups()) {
        shown += group.fields;
        QWidget* form = new FieldForm(document, preferences, pick(fields, group.fields), &prices);
        if (group.fields.contains("angularStiffness")) form = withCurve(document, form);
        layout->insertWidget(layout->count() - 1, collapsible(group.title, form, group.open));
    }
    // Fields that the engine has gained since.
    QStringList others;
    for (const Field& field : fields) {
        if (!shown.contains(field.name)) others.append(field.name);
    }
    if (!others.isEmpty()) {
        auto* form = new FieldForm(document, preferences, pick(fields, others), &prices);
        layout->insertWidget(layout->count() - 1, collapsible(QObject::tr("More"), form, false));
    }
    return scrolled(content);
}

}  // namespace

PanelInfo physicsPanel() {
    return {
        "physics",
        QObject::tr("Physics"),
        "physics",
        Qt::RightDockWidgetArea,
        60,
        true,
        [](const PanelParts& parts) { return makePanel(parts.document, parts.preferences, parts.prices); }};
}

}  // namespace hairloom::editor
