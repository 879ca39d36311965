// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/fields/field.h"

#include <QObject>
#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/editing/settings_commands.h"
#include "core/editing/stack_commands.h"
#include "core/operations/found_vectors.h"
#include "core/operations/script.h"
#include "core/operations/stack.h"
#include "editor/document/words.h"
#include "editor/fields/mask_name_edit.h"
#include "editor/fields/number_spin.h"

namespace hairloom::editor {
namespace {

/// `edit` gives null where there is nothing to change.
template <class S, class Read, class Edit>
std::vector<Field> fieldsIn(Read read, Edit edit, editing::Part part) {
    std::vector<Field> fields;
    for (const runtime::Field<S>& described : fieldsOf(S{})) {
        if (described.components() == 0) continue;
        Field field{described, labelOf(described.name), {}, part, {}, {}, {}, {}};
        for (std::uint32_t c = 0; c < field.components(); ++c)
            field.defaultValue[c] = defaultValue(described, c);
        field.value = [&described, read](const Groom& groom, std::uint32_t component) {
            return fieldValue(read(groom), described, component);
        };
        field.set = [&described, edit](Groom& groom, double value, std::uint32_t component) {
            S* const settings = edit(groom);
            return settings && setFieldValue(*settings, described, value, component);
        };
        fields.push_back(std::move(field));
    }
    return fields;
}

template <class S>
std::vector<Field> fieldsIn(S Groom::*section, editing::Part part) {
    return fieldsIn<S>([section](const Groom& groom) -> const S& { return groom.*section; },
                       [section](Groom& groom) { return &(groom.*section); }, part);
}

constexpr FieldInfo kDensity{
    "layerDensity",   "", 0, kMaxLayerDensity, "multiplies the interpolated hairs per guide on this layer",
    FieldKind::Float, {}};

std::unique_ptr<editing::Command> setLayersOf(const editing::Model& model, const Groom& groom) {
    return editing::setLayers(model, groom.layers);
}

constexpr FieldInfo kWeight{"weight",         "", 0, 1, "how much of the operator's effect is applied",
                            FieldKind::Float, {}};

/// What fields of an operator share.
struct OperatorAt {
    std::size_t index;
    std::string op;
    SayError failed;

    const Operator* in(const Groom& groom) const {
        if (index >= groom.operators.size() || groom.operators[index].op != op) return nullptr;
        return &groom.operators[index];
    }
    Field field(const FieldInfo& info) const {
        Field field{info, labelOf(info.name), {}, editing::Part::Operators, {}, {}, {}, {}};
        const std::string name =
            labelOf(QString::fromStdString(op)).toStdString() + ": " + field.label.toStdString();
        field.step = [at = *this, name](const editing::Model& model,
                                        const Groom& groom) -> std::unique_ptr<editing::Command> {
            const Operator* changed = at.in(groom);
            if (!changed) return nullptr;
            auto made = editing::setOperator(model, at.index, *changed, name);
            if (made) return std::move(*made);
            at.failed(errorText(made.error()));
            return nullptr;
        };
        return field;
    }
};

std::vector<Field> settingsFields(const Groom& onHead, const OperatorAt& at,
                                  const std::vector<FieldRow>& rows, SettingsPart part) {
    std::vector<Field> fields;
    const Operator fresh = newOperator(at.op, headScale(onHead));
    for (const FieldRow& row : rows) {
        if (row.info.components() == 0) continue;
        Field field = at.field(row.info);
        for (std::uint32_t c = 0; c < field.components(); ++c)
            field.defaultValue[c] = settingOf(fresh, row.info, c, part);
        field.value = [at, info = row.info, part](const Groom& groom, std::uint32_t component) {
            const Operator* one = at.in(groom);
            return one ? settingOf(*one, info, component, part) : 0;
        };
        field.set = [at, info = row.info, part](Groom& groom, double value, std::uint32_t component) {
            return at.in(groom) && setSettingOf(groom.operators[at.index], info, value, component, part);
        };
        if (field.kind == FieldKind::Vector) {
            field.found = [at, info = row.info, part](const Groom& groom) -> std::optional<Vec3f> {
                const Operator* one = at.in(groom);
                return one ? vectorFound(groom, *one, info, part) : std::nullopt;
            };
        }
        fields.push_back(std::move(field));
    }
    return fields;
}

}  // namespace

std::vector<Field> operatorFields(const Groom& groom, std::size_t index, const SayError& failed) {
    const OperatorAt at{index, groom.operators[index].op, failed};
    const StackOperator* const known = findStackOperator(at.op);
    std::vector<Field> fields = settingsFields(groom, at, known->fields, SettingsPart::own);
    Field weight = at.field(kWeight);
    weight.defaultValue[0] = 1;
    weight.value = [at](const Groom& now, std::uint32_t) {
        const Operator* one = at.in(now);
        return one ? static_cast<double>(one->weight) : 1;
    };
    weight.set = [at](Groom& now, double value, std::uint32_t) {
        if (!at.in(now) || !kWeight.holds(value)) return false;
        now.operators[at.index].weight = static_cast<float>(value);
        return true;
    };
    fields.insert(fields.begin(), std::move(weight));
    return fields;
}

std::vector<Field> operatorRegionFields(const Groom& groom, std::size_t index, const SayError& failed) {
    const OperatorAt at{index, groom.operators[index].op, failed};
    return settingsFields(groom, at, scriptRegionFields(), SettingsPart::region);
}

std::vector<Field> operatorMaskFields(const Groom& groom, std::size_t index, const SayError& failed) {
    const OperatorAt at{index, groom.operators[index].op, failed};
    std::vector<Field> fields = settingsFields(groom, at, scriptMaskFields(), SettingsPart::mask);
    for (Field& field : fields) {
        if (field.name != std::string_view("map")) continue;
        field.part = field.part | editing::Part::MaskNames;
        // Those of the groom are the last.
        field.choicesIn = [labels = field.choiceLabels()](const Groom& now) {
            return labels.first(labels.size() - static_cast<qsizetype>(kPaintedMasks)) + maskLabels(now);
        };
    }
    return fields;
}

QStringList Field::choiceLabels() const {
    QStringList labels;
    for (const char* choice : choices) labels.append(labelOf(choice));
    return labels;
}

std::vector<Field> simulationFields() {
    return fieldsIn(&Groom::simulation, editing::Part::Physics);
}

std::vector<Field> materialFields() {
    return fieldsIn(&Groom::material, editing::Part::Material);
}

std::vector<Field> followHairFields() {
    return fieldsIn(&Groom::interpolation, editing::Part::Interpolation);
}

std::vector<Field> shadowFields() {
    // Names that stand beside those of other settings of pictures, and that prices have.
    constexpr std::pair<const char*, const char*> kNames[] = {
        {"kind", "shadows"},        {"filter", "shadowFilter"}, {"resolution", "shadowResolution"},
        {"layers", "shadowLayers"}, {"slices", "shadowSlices"}, {"nodes", "shadowNodes"},
        {"blur", "shadowBlur"}};
    std::vector<Field> fields = fieldsIn(&Groom::shadows, editing::Part::Shadows);
    for (Field& field : fields) {
        for (const auto& [name, shown] : kNames) {
            if (field.name != std::string_view(name)) continue;
            field.name = shown;
            field.label = labelOf(shown);
            break;
        }
    }
    return fields;
}

std::vector<Field> placementFields() {
    return fieldsIn(&Groom::placement, editing::Part::Placement);
}

Field layerDensityField(std::size_t index) {
    Field field{kDensity, QString("Density"), {1, 0, 0}, editing::Part::Layers, {}, {}, setLayersOf, {}};
    field.value = [index](const Groom& groom, std::uint32_t) {
        return index < groom.layers.size() ? static_cast<double>(groom.layers[index].density) : 1;
    };
    field.set = [index](Groom& groom, double value, std::uint32_t) {
        if (index >= groom.layers.size() || !kDensity.holds(value)) return false;
        groom.layers[index].density = static_cast<float>(value);
        return true;
    };
    return field;
}

std::vector<Field> layerMaterialFields(std::size_t index) {
    std::vector<Field> fields = fieldsIn<HairMaterial>(
        [index](const Groom& groom) -> const HairMaterial& { return groom.materialOf(index); },
        [index](Groom& groom) -> HairMaterial* {
            if (index >= groom.layers.size()) return nullptr;
            groom.layers[index].material = groom.materialOf(index);
            return &*groom.layers[index].material;
        },
        editing::Part::Layers | editing::Part::Material);
    for (Field& field : fields) field.step = setLayersOf;
    return fields;
}

std::vector<Field> poseFields(std::size_t index) {
    std::vector<Field> fields = fieldsIn<GroomPose>(
        [index](const Groom& groom) -> const GroomPose& {
            static const GroomPose kNone;
            return index < groom.poses.size() ? groom.poses[index] : kNone;
        },
        [index](Groom& groom) { return index < groom.poses.size() ? &groom.poses[index] : nullptr; },
        editing::Part::Physics);
    // Names that stand beside those of operators and of other panels.
    constexpr std::pair<std::string_view, const char*> kNames[] = {
        {"amount", "poseAmount"}, {"mask", "poseMask"}, {"invert", "poseInvert"}};
    for (Field& field : fields) {
        for (const auto& [name, shown] : kNames) {
            if (field.name == name) field.name = shown;
        }
        field.step = [name = field.label.toStdString()](const editing::Model& model, const Groom& groom) {
            return editing::setPoses(model, groom.poses, "Pose: " + name)
                .value_or(std::unique_ptr<editing::Command>());
        };
    }
    return fields;
}

std::vector<Field> pick(const std::vector<Field>& all, const QStringList& names) {
    std::vector<Field> picked;
    for (const QString& name : names) {
        const auto found =
            std::ranges::find_if(all, [&](const Field& field) { return name == QLatin1String(field.name); });
        assert(found != all.end());
        picked.push_back(*found);
    }
    return picked;
}

Shown shownAs(const QString& unit, double min, double max, DisplayUnit lengths) {
    Shown shown{1, unit, 2};
    if (unit == "m") {
        if (max <= 0.006 || (min > 0 && min < 1e-4)) return {1e6, QStringLiteral("µm"), 1};
        // Of what is small a tenth of a millimetre is to be seen.
        const int finer = max <= 0.11 ? 1 : 0;
        switch (lengths) {
            case DisplayUnit::Metre:
                return {1, QStringLiteral("m"), 4 + finer};
            case DisplayUnit::Centimetre:
                return {100, QStringLiteral("cm"), 2 + finer};
            case DisplayUnit::Millimetre:
                return {1000, QStringLiteral("mm"), 1 + finer};
            case DisplayUnit::Inch:
                return {1 / 0.0254, QStringLiteral("in"), 3 + finer};
        }
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
    const auto sentence = [](const QString& text) { return asSentence(text).toHtmlEscaped(); };
    QString text = QStringLiteral("<p><b>%1</b></p><p>%2</p>")
                       .arg(field.label, sentence(QString::fromUtf8(field.meaning)));
    if (field.kind == FieldKind::Choice) {
        return text + QString("<p>Default: %1</p>")
                          .arg(field.choiceLabels().value(static_cast<int>(field.defaultValue[0])));
    }
    if (field.kind == FieldKind::Bool || field.kind == FieldKind::Colour) return text;
    const Shown shown = shownAs(QString::fromUtf8(field.unit), field.min, field.max, lengths);
    const auto number = [&](double value) { return numberLocale().toString(value * shown.factor, 'g', 6); };
    text += QString("<p>%1 to %2 %3; default %4</p>")
                .arg(number(field.min), number(field.max),
                     shown.unit.isEmpty() ? QString() : shown.unit.toHtmlEscaped(),
                     number(field.defaultValue[0]));
    return text;
}

}  // namespace hairloom::editor
