// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/fields/field.h"

#include <QObject>
#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/groom/file/fields.h"
#include "hairloom/settings.h"

namespace hairloom::editor {
namespace {

using Table = runtime::FieldInfo;

Field fromEngine(const Table& info) {
    Field field;
    field.name = info.name;
    field.label = labelOf(field.name);
    field.unit = QString::fromUtf8(info.unit);
    field.meaning = QString::fromUtf8(info.meaning);
    field.min = info.min;
    field.max = info.max;
    for (const char* choice : info.choices) field.choices.append(labelOf(choice));
    for (std::uint32_t c = 0; c < runtime::componentCount(info); ++c) {
        field.standard[c] = runtime::defaultValue(info, c);
    }
    if (!field.choices.isEmpty()) {
        field.kind = FieldKind::Choice;
    } else if (runtime::componentCount(info) == 3) {
        field.kind = FieldKind::Vector;
    } else if (std::holds_alternative<std::uint32_t runtime::SimulationSettings::*>(info.member)) {
        field.kind = FieldKind::Whole;
    }
    field.changes = Change::Simulation;
    field.value = [&info](const Groom& groom, std::uint32_t component) {
        return runtime::fieldValue(groom.simulation, info, component);
    };
    field.set = [&info](Groom& groom, double value, std::uint32_t component) {
        return runtime::setFieldValue(groom.simulation, info, value, component);
    };
    return field;
}

template <class S>
void store(S& settings, const hairloom::Field<S>& info, double value, std::uint32_t component) {
    std::visit(
        [&](auto member) {
            using Member = decltype(member);
            if constexpr (!mayHold<S, Member>()) {
                return;
            } else if constexpr (std::is_same_v<Member, Vec3f S::*>) {
                (settings.*member)[component] = static_cast<float>(value);
            } else {
                using Value = std::remove_reference_t<decltype(settings.*member)>;
                settings.*member = static_cast<Value>(value);
            }
        },
        info.member);
}

template <class S>
FieldKind kindOf(const hairloom::Field<S>& info) {
    if (std::holds_alternative<Vec3f S::*>(info.member)) return FieldKind::Colour;
    if (std::holds_alternative<bool S::*>(info.member)) return FieldKind::Truth;
    return std::holds_alternative<float S::*>(info.member) ? FieldKind::Number : FieldKind::Whole;
}

template <class S>
Field fromTable(const hairloom::Field<S>& info, S Groom::*section, Changes changes) {
    Field field;
    field.name = info.name;
    field.label = labelOf(field.name);
    field.unit = QString::fromUtf8(info.unit);
    field.meaning = QString::fromUtf8(info.meaning);
    field.kind = kindOf(info);
    field.min = info.min;
    field.max = info.max;
    field.changes = changes;
    for (std::uint32_t c = 0; c < componentCount(info); ++c) field.standard[c] = fieldValue(S{}, info, c);
    field.value = [&info, section](const Groom& groom, std::uint32_t component) {
        return fieldValue(groom.*section, info, component);
    };
    field.set = [&info, section](Groom& groom, double value, std::uint32_t component) {
        if (!withinRange(value, info.min, info.max)) return false;
        store(groom.*section, info, value, component);
        return true;
    };
    return field;
}

template <class S>
std::vector<Field> fromTable(S Groom::*section, Changes changes) {
    std::vector<Field> fields;
    for (const hairloom::Field<S>& info : fieldsOf(S{})) fields.push_back(fromTable(info, section, changes));
    return fields;
}

}  // namespace

std::vector<Field> simulationFields() {
    std::vector<Field> fields;
    for (const Table& info : runtime::fields()) {
        if (runtime::componentCount(info) > 0) fields.push_back(fromEngine(info));
    }
    return fields;
}

std::vector<Field> materialFields() {
    return fromTable(&Groom::material, Change::Look);
}

std::vector<Field> followHairFields() {
    return fromTable(&Groom::interpolation, Change::FollowHairs);
}

std::vector<Field> placementFields() {
    return fromTable(&Groom::placement, Change::Placement);
}

std::vector<Field> pick(const std::vector<Field>& all, const QStringList& names) {
    std::vector<Field> picked;
    for (const QString& name : names) {
        const auto found = std::ranges::find(all, name, &Field::name);
        assert(found != all.end());
        picked.push_back(*found);
    }
    return picked;
}

QString labelOf(const QString& name) {
    QString label;
    for (const QChar letter : name) {
        if (letter.isUpper() && !label.isEmpty()) label += ' ';
        label += label.isEmpty() ? letter.toUpper() : letter.toLower();
    }
    // The unit stands beside the value.
    for (const QLatin1String unit : {QLatin1String(" degrees"), QLatin1String(" per cm2")}) {
        if (label.endsWith(unit)) label.chop(unit.size());
    }
    return label;
}

Shown shownAs(const QString& unit, double min, double max, DisplayUnit lengths) {
    Shown shown{1, unit, 2};
    if (unit == "m") {
        if (max <= 0.006) {
            shown = {1e6, QStringLiteral("µm"), 1};
        } else if (max <= 0.11) {
            shown = {1e3, QStringLiteral("mm"), 2};
        } else {
            switch (lengths) {
                case DisplayUnit::Metre:
                    shown = {1, QStringLiteral("m"), 4};
                    break;
                case DisplayUnit::Centimetre:
                    shown = {100, QStringLiteral("cm"), 2};
                    break;
                case DisplayUnit::Millimetre:
                    shown = {1000, QStringLiteral("mm"), 1};
                    break;
                case DisplayUnit::Inch:
                    shown = {1 / 0.0254, QStringLiteral("in"), 3};
                    break;
            }
        }
        return shown;
    }
    const double range = max - min;
    if (range <= 0.5) {
        shown.decimals = 4;
    } else if (range <= 10) {
        shown.decimals = 3;
    } else if (range >= 1000) {
        shown.decimals = 1;
    }
    return shown;
}

QString tooltipOf(const Field& field, DisplayUnit lengths) {
    const auto sentence = [](QString text) {
        if (!text.isEmpty()) text[0] = text[0].toUpper();
        return text.toHtmlEscaped();
    };
    QString text = QStringLiteral("<p><b>%1</b></p><p>%2</p>").arg(field.label, sentence(field.meaning));
    if (field.kind == FieldKind::Choice) {
        return text + QObject::tr("<p>Standard: %1</p>")
                          .arg(field.choices.value(static_cast<int>(field.standard[0])));
    }
    if (field.kind == FieldKind::Truth || field.kind == FieldKind::Colour) return text;
    const Shown shown = shownAs(field.unit, field.min, field.max, lengths);
    const auto number = [&](double value) { return QString::number(value * shown.factor, 'g', 6); };
    text +=
        QObject::tr("<p>%1 to %2 %3; standard %4</p>")
            .arg(number(field.min), number(field.max),
                 shown.unit.isEmpty() ? QString() : shown.unit.toHtmlEscaped(), number(field.standard[0]));
    return text;
}

}  // namespace hairloom::editor
