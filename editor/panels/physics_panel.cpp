// SPDX-License-Identifier: GPL-3.0-or-later
// How the hair moves: presets of measured hair, and all settings of the engine. A change shows in the running
// simulation at once.
#include <QComboBox>
#include <QPushButton>
#include <QVBoxLayout>

#include "core/documents/hair_preset.h"
#include "core/editing/document.h"
#include "core/editing/settings_commands.h"
#include "core/simulation/sag.h"
#include "editor/document/words.h"
#include "editor/fields/field_form.h"
#include "editor/fields/stiffness_curve.h"
#include "editor/fields/strand_stiffness.h"
#include "editor/panels/key_this.h"
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
        {QString("Strands"),
         {"strandModel", "angularStiffness", "torsionRatio", "sectionRatio", "bendDampingTime",
          "restGravity"},
         true},
        {QString("Time"), {"substeps", "dampingTime", "teleportDistance", "sleepSpeed", "sleepDelay"}, true},
        {QString("Wind and gravity"),
         {"windSpeed", "windKind", "windDirection", "windGustiness", "windFrequency", "windGustSize",
          "windSeed", "windShelter", "airDrag", "gravity"},
         true},
        {QString("Collision"),
         {"collisionRadiusRoot", "collisionRadiusTip", "friction", "restitution"},
         false},
        {QString("Hair-hair collision"),
         {"hairHair", "hairHairStrength", "hairHairFriction", "hairHairStickSpeed", "hairHairCohesion",
          "hairHairCell"},
         false},
        {QString("Springs only"),
         {"integrator", "angularMethod", "lengthMethod", "lengthIterations", "maximalExtension",
          "springFrequency", "collisionResponse", "penaltyFrequency", "collisionSegments"},
         false},
        {QString("Lattice only"),
         {"latticeNodes", "latticeRootFrequency", "latticeTipFrequency", "latticeCouplingFrequency"},
         false},
    };
}

QWidget* makePresets(QtDocument& document) {
    auto* box = new QComboBox;
    box->setObjectName("preset");
    box->setToolTip("Stiffness, cross-section and colour of measured hair. Motion settings do not change");
    box->addItem("Measured hair preset…");
    for (const runtime::HairPreset& preset : runtime::presets()) {
        box->addItem(labelOf(preset.name));
        box->setItemData(box->count() - 1, QString::fromUtf8(preset.description), Qt::ToolTipRole);
    }
    QObject::connect(box, &QComboBox::activated, box, [&document, box](int index) {
        if (index == 0) return;
        const runtime::HairPreset& preset = runtime::presets()[static_cast<std::size_t>(index - 1)];
        Groom groom = document.groom();
        applyPreset(preset, groom);
        const QString step = QString("Preset %1").arg(box->itemText(index));
        document.perform(editing::setSettings(document.editing().model(), groom, step.toStdString()));
        box->setCurrentIndex(0);
    });
    return box;
}

QWidget* makeHoldButton(QtDocument& document) {
    auto* button = new QPushButton("Keep shape under gravity");
    button->setObjectName("hold-shape");
    button->setToolTip(
        "Turns strands into rods whose rest shape already carries their weight, so the hair "
        "keeps the shape you drew");
    QObject::connect(button, &QPushButton::clicked, button, [&document] {
        document.perform(editing::setPhysics(document.editing().model(),
                                             holdingItsShape(document.groom()).simulation,
                                             "Keep shape under gravity"));
    });
    return button;
}

/// What the preview moves the hair by, with what it costs in the panel Effects and in the status line.
QWidget* makeMethods(Player& player) {
    auto* box = new QComboBox;
    box->setObjectName("play-method");
    box->setToolTip(
        "Method that simulates hair during playback here. Exported files and games use the "
        "strand engine. Try the others to compare their cost and accuracy");
    const std::pair<QString, SimulationMethod> methods[] = {
        {QString("Strand engine (rods or springs)"), SimulationMethod::strands},
        {QString("Projective equations"), SimulationMethod::projective},
        {QString("Rigid chains"), SimulationMethod::chain},
        {QString("Lattice, for distant hair"), SimulationMethod::lattice},
        {QString("Strand engine and particles"), SimulationMethod::particles},
        {QString("Strand engine and a flow grid"), SimulationMethod::hybrid}};
    for (const auto& [name, method] : methods) box->addItem(name, static_cast<int>(method));
    QObject::connect(box, &QComboBox::currentIndexChanged, box, [&player, box] {
        player.setMethod({static_cast<SimulationMethod>(box->currentData().toInt())});
    });
    return box;
}

QWidget* makePanel(QtDocument& document, const Preferences& preferences, const Prices& prices, Player& player,
                   Keying& keying, Messages& messages) {
    const std::vector<Field> fields = simulationFields();
    QWidget* const content = column({makePresets(document), makeHoldButton(document)});
    auto* layout = static_cast<QVBoxLayout*>(content->layout());
    auto* keys = new KeyThis(keying, "simulation", content);
    QStringList shown;
    for (const Group& group : groups()) {
        shown += group.fields;
        QWidget* form = new FieldForm(document, preferences, pick(fields, group.fields), &prices, keys);
        if (group.fields.contains("angularStiffness")) form = stacked({new StiffnessCurve(document), form});
        layout->insertWidget(layout->count() - 1, collapsible(group.title, form, group.open));
        if (group.fields.contains("angularStiffness"))
            layout->insertWidget(
                layout->count() - 1,
                collapsible("Stiffness by region", new StrandStiffness(document, messages), false));
    }
    layout->insertWidget(layout->count() - 1, collapsible("During playback", makeMethods(player), false));
    // Fields that the engine has gained since.
    QStringList others;
    for (const Field& field : fields) {
        if (!shown.contains(field.name)) others.append(field.name);
    }
    if (!others.isEmpty()) {
        auto* form = new FieldForm(document, preferences, pick(fields, others), &prices, keys);
        layout->insertWidget(layout->count() - 1, collapsible("More", form, false));
    }
    return scrolled(content);
}

}  // namespace

PanelInfo physicsPanel() {
    return {"physics",
            QString("Physics"),
            "physics",
            Qt::RightDockWidgetArea,
            60,
            true,
            [](const PanelParts& parts) {
                return makePanel(parts.document, parts.preferences, parts.prices, parts.player, parts.keying,
                                 parts.messages);
            }};
}

}  // namespace hairloom::editor
