// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A described field of a groom (hairloom/field.h) as a panel shows it.

#include <QString>
#include <QStringList>
#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "core/groom/file/fields.h"
#include "editor/document/preferences.h"
#include "editor/document/qt_document.h"

namespace hairloom::editor {

class FormulaEdit;

struct Field : FieldInfo {
    QString label;                             ///< "Wind speed"
    std::array<double, 3> defaultValue{};      ///< the default of each component
    editing::Part part = editing::Part::None;  ///< that a change of it touches
    std::function<double(const Groom&, std::uint32_t component)> value;
    /// False, and no change, where the value is not allowed.
    std::function<bool(Groom&, double value, std::uint32_t component)> set;

    /// The step that gives the document what set() made of its groom; settings as a whole where it is empty.
    std::function<std::unique_ptr<editing::Command>(const editing::Model&, const Groom&)> step;

    /// Lets a person point at the place that it holds; empty where it holds none.
    std::function<void()> pick;

    /// Makes the control of its formula; empty where it takes none.
    std::function<FormulaEdit*()> formula{};

    /// What the vector stands for where it is zero and the operator finds a place or direction itself;
    /// nothing where zero is meant. Empty: zero is always meant.
    std::function<std::optional<Vec3f>(const Groom&)> found{};

    /// What its choices are called in a groom that names some of them itself; empty: choiceLabels().
    std::function<QStringList(const Groom&)> choicesIn{};

    QStringList choiceLabels() const;
};

/// All but curves, which have controls of their own.
std::vector<Field> simulationFields();
std::vector<Field> materialFields();
std::vector<Field> followHairFields();
std::vector<Field> shadowFields();
std::vector<Field> placementFields();
/// The density of the layer at `index`, or the material that it has of its own.
Field layerDensityField(std::size_t index);
std::vector<Field> layerMaterialFields(std::size_t index);
/// Of the pose at `index`, but its ramp.
std::vector<Field> poseFields(std::size_t index);
/// Weight and settings of the operator at `index`, or those of its region, or of its mask but the ramp. A
/// complaint of an operator goes to `failed`.
using SayError = std::function<void(const QString&)>;
std::vector<Field> operatorFields(const Groom& groom, std::size_t index, const SayError& failed);
std::vector<Field> operatorRegionFields(const Groom& groom, std::size_t index, const SayError& failed);
std::vector<Field> operatorMaskFields(const Groom& groom, std::size_t index, const SayError& failed);

/// The fields of these names, in that order. Each name is one of `all`.
std::vector<Field> pick(const std::vector<Field>& all, const QStringList& names);

/// How a value is shown: times `factor`, in `unit`. Metres become the unit of the preferences; those of
/// fibres, which are far smaller, micrometres.
struct Shown {
    double factor = 1;
    QString unit;
    int decimals = 2;
};
Shown shownAs(const QString& unit, double min, double max, DisplayUnit lengths);

/// What turning it does, its unit, range and default, for a tooltip.
QString tooltipOf(const Field& field, DisplayUnit lengths);

}  // namespace hairloom::editor
