// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/fields/stiffness_curve.h"

#include "core/editing/settings_commands.h"

namespace hairloom::editor {

StiffnessCurve::StiffnessCurve(QtDocument& document, QWidget* parent)
    : RampEdit(parent), document_(document) {
    setObjectName("stiffnessCurve");
    setToolTip(
        "<p><b>Stiffness from root to tip</b></p><p>Drag a key to change how strongly hair returns to its "
        "shape there: 0 is off, 0.5 is real hair, 1 is rigid. Click the line to add a key. Right-click or "
        "press Delete to remove one. Arrow keys move the last key you touched.</p>");
    connect(&document_, &QtDocument::changed, this, [this](editing::Part parts) {
        if (contains(parts, editing::Part::Physics)) refresh();
    });
    connect(this, &RampEdit::begun, this, [this] { interaction_ = QtDocument::nextMergeKey(); });
    connect(this, &RampEdit::edited, this, &StiffnessCurve::store);
    refresh();
}

void StiffnessCurve::refresh() {
    const auto& settings = document_.groom().simulation;
    runtime::Ramp levels = settings.angularCurve;
    for (runtime::Ramp::Key& key : levels.keys) key.value *= settings.angularStiffness;
    setRamp(levels);
}

void StiffnessCurve::store(const runtime::Ramp& levels) {
    runtime::SimulationSettings settings = document_.groom().simulation;
    settings.angularStiffness = levels.greatest();
    settings.angularCurve = levels;
    for (runtime::Ramp::Key& key : settings.angularCurve.keys)
        key.value = settings.angularStiffness > 0 ? key.value / settings.angularStiffness : 1;
    document_.performMerged(interaction_, [&](const editing::Model& model) {
        return editing::setPhysics(model, settings, "Stiffness curve");
    });
}

}  // namespace hairloom::editor
