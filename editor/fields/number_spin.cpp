// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/fields/number_spin.h"

namespace hairloom::editor {

const QLocale& numberLocale() {
    static const QLocale locale(QLocale::English, QLocale::UnitedStates);
    return locale;
}

QString withDecimalPoint(QString typed) {
    const qsizetype commas = typed.count(','), points = typed.count('.');
    if (commas == 0) return typed;
    if (points == 0 && commas == 1) return typed.replace(',', '.');
    // Of both, the last is the decimal one; of several alike, all set thousands apart.
    const bool commaIsLast = typed.lastIndexOf(',') > typed.lastIndexOf('.');
    if (points > 0 && commaIsLast && commas == 1) return typed.remove('.').replace(',', '.');
    if (points <= 1 && !(points == 1 && commaIsLast)) return typed.remove(',');
    return typed;
}

NumberSpin::NumberSpin(QWidget* parent) : QDoubleSpinBox(parent) {
    setLocale(numberLocale());
    setKeyboardTracking(false);
}

QValidator::State NumberSpin::validate(QString& text, int& position) const {
    // A comma in a count sets thousands apart.
    if (decimals() > 0) {
        const qsizetype before = text.size();
        text = withDecimalPoint(text);
        position -= static_cast<int>(before - text.size());
    }
    return QDoubleSpinBox::validate(text, position);
}

double NumberSpin::valueFromText(const QString& text) const {
    return QDoubleSpinBox::valueFromText(decimals() > 0 ? withDecimalPoint(text) : text);
}

void NumberSpin::follow(double value) {
    QString typed = text();
    int position = 0;
    const bool isTyping = hasFocus() && (validate(typed, position) != QValidator::Acceptable ||
                                         valueFromText(typed) != this->value());
    if (!isTyping) setValue(value);
}

}  // namespace hairloom::editor
