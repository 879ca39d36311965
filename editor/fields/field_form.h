// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Controls for described fields, one row each: label, control, and a way back to the default. They follow
// the document and change it through its commands.

#include <QGridLayout>
#include <QWidget>
#include <functional>
#include <vector>

#include "editor/document/preferences.h"
#include "editor/document/prices.h"
#include "editor/fields/field.h"
#include "editor/fields/field_keys.h"

namespace hairloom::editor {

class FieldForm : public QWidget {
    Q_OBJECT

  public:
    /// With `prices`, rows of settings that have some show them; with `keys`, those that are keyed.
    FieldForm(QtDocument& document, const Preferences& preferences, std::vector<Field> fields,
              const Prices* prices = nullptr, FieldKeys* keys = nullptr, QWidget* parent = nullptr);

    /// The control of a field, for tests and help; null where there is none of that name. Objects are named
    /// after their fields.
    QWidget* control(const QString& name) const { return findChild<QWidget*>(name); }

  private:
    void addRow(const Field& field);
    QWidget* pickButton(const Field& field);
    /// The number with a button for its formula, which is shown in the row below.
    QWidget* withFormula(const Field& field, QWidget* number, int row);
    /// In the unit of the preferences.
    Shown shownOf(const Field& field) const;
    QWidget* makeNumber(const Field& field);
    QWidget* makeGroundTruth(const Field& field);
    QWidget* makeChoice(const Field& field);
    QWidget* makeVector(const Field& field);
    QWidget* makeColour(const Field& field);
    /// A change of one component that belongs to the interaction which began last.
    void store(const Field& field, double value, std::uint32_t component = 0);
    void begin();
    void refresh(editing::Part parts);

    QtDocument& document_;
    const Preferences& preferences_;
    const Prices* prices_;
    FieldKeys* keys_;
    std::vector<Field> fields_;
    QGridLayout* grid_;
    editing::Part shown_ = editing::Part::None;  ///< parts that the fields are of
    std::vector<std::function<void()>> refreshers_;
    quint64 interaction_ = 0;
};

}  // namespace hairloom::editor
