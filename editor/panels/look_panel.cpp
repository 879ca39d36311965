// SPDX-License-Identifier: GPL-3.0-or-later
// How the hair looks: colour, thickness, scattering, and the hairs between the guides. The controls follow
// the table of material fields, so that those of a new shading model appear by themselves.
#include <QComboBox>
#include <algorithm>

#include "editor/fields/field_form.h"
#include "editor/panels/list.h"
#include "editor/panels/panel.h"
#include "editor/session.h"
#include "workspace/hair_preset.h"

namespace hairloom::editor {
namespace {

const QStringList kColour{"rootColour", "tipColour", "colourVariation"};
const QStringList kPigment{"eumelanin", "pheomelanin"};
const QStringList kFibre{"rootRadius", "tipScale"};

FieldForm* form(Session& session, const std::vector<Field>& fields) {
    return new FieldForm(session.document, session.preferences, fields);
}

/// Those that no other group shows.
std::vector<Field> scatteringFields(const std::vector<Field>& all) {
    std::vector<Field> rest;
    const QStringList elsewhere = kColour + kPigment + kFibre;
    std::ranges::copy_if(all, std::back_inserter(rest),
                         [&](const Field& field) { return !elsewhere.contains(field.name); });
    return rest;
}

}  // namespace

QWidget* makeLookPanel(Session& session) {
    const std::vector<Field> fields = materialFields();
    return scrolled(column({
        foldable(QObject::tr("Colour"), form(session, pick(fields, kColour))),
        foldable(QObject::tr("Pigment"), form(session, pick(fields, kPigment))),
        foldable(QObject::tr("Fibre"), form(session, pick(fields, kFibre))),
        foldable(QObject::tr("Scattering"), form(session, scatteringFields(fields))),
        foldable(QObject::tr("Hairs between the guides"), form(session, followHairFields())),
    }));
}

}  // namespace hairloom::editor
