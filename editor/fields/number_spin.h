// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How the window reads and writes numbers: one way for all of it, whatever the system's language.

#include <QDoubleSpinBox>
#include <QLocale>
#include <QString>

namespace hairloom::editor {

/// A point before decimals, a comma between thousands: "42.9 cm", "9,600 points".
const QLocale& numberLocale();

/// A number as people type it, with a decimal point: "0,4" and "0.4" are the same, thousands may be set
/// apart. What is no number comes back as it is.
QString withDecimalPoint(QString typed);

/// A spin box that takes decimal commas as well as points.
class NumberSpin : public QDoubleSpinBox {
    Q_OBJECT

  public:
    explicit NumberSpin(QWidget* parent = nullptr);

    QValidator::State validate(QString& text, int& position) const override;
    double valueFromText(const QString& text) const override;
    /// As setValue(), but leaves alone what somebody types.
    void follow(double value);
};

}  // namespace hairloom::editor
