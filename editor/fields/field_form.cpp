// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/fields/field_form.h"

#include <QCheckBox>
#include <QColorDialog>
#include <QComboBox>
#include <QLabel>
#include <QPushButton>
#include <QSignalBlocker>
#include <QStyle>
#include <QToolButton>

#include "core/editing/settings_commands.h"
#include "editor/fields/colour.h"
#include "editor/fields/formula_edit.h"
#include "editor/fields/number_box.h"
#include "editor/fields/number_spin.h"
#include "editor/fields/price_tag.h"
#include "editor/style/icons.h"

namespace hairloom::editor {

FieldForm::FieldForm(QtDocument& document, const Preferences& preferences, std::vector<Field> fields,
                     const Prices* prices, FieldKeys* keys, QWidget* parent)
    : QWidget(parent),
      document_(document),
      preferences_(preferences),
      prices_(prices),
      keys_(keys),
      fields_(std::move(fields)),
      grid_(new QGridLayout(this)) {
    grid_->setContentsMargins(0, 0, 0, 0);
    grid_->setHorizontalSpacing(6);
    grid_->setVerticalSpacing(5);
    grid_->setColumnStretch(1, 3);
    grid_->setColumnMinimumWidth(0, 70);
    grid_->setColumnStretch(0, 2);
    for (const Field& field : fields_) {
        shown_ = shown_ | field.part;
        if (field.found) shown_ = shown_ | editing::kScalpParts;  // it is found on the head
        addRow(field);
    }
    connect(&document_, &QtDocument::changed, this, &FieldForm::refresh);
    connect(&preferences_, &Preferences::changed, this, [this] { refresh(editing::Part::Everything); });
    if (keys_) connect(keys_, &FieldKeys::changed, this, [this] { refresh(shown_); });
    refresh(editing::Part::Everything);
}

void FieldForm::addRow(const Field& field) {
    QWidget* control = nullptr;
    switch (field.kind) {
        case FieldKind::Bool:
            control = makeGroundTruth(field);
            break;
        case FieldKind::Choice:
            control = makeChoice(field);
            break;
        case FieldKind::Vector:
            control = makeVector(field);
            break;
        case FieldKind::Colour:
            control = makeColour(field);
            break;
        case FieldKind::Float:
        case FieldKind::Int:
        case FieldKind::Seed:
        case FieldKind::Ramp:
            control = makeNumber(field);
            break;
    }
    control->setObjectName(field.name);
    auto* label = new QLabel(field.label);
    label->setWordWrap(true);
    label->setBuddy(control);
    auto* defaultValue = new QToolButton;
    defaultValue->setObjectName("default");
    defaultValue->setIcon(icon("reset"));
    defaultValue->setIconSize({12, 12});
    defaultValue->setAutoRaise(true);
    defaultValue->setToolTip("Reset to the default value");
    defaultValue->setAccessibleName(QString("%1: back to the default value").arg(field.label));
    connect(defaultValue, &QToolButton::clicked, this, [this, &field] {
        begin();
        for (std::uint32_t c = 0; c < field.components(); ++c) store(field, field.defaultValue[c], c);
    });
    const int row = grid_->rowCount() + (field.kind == FieldKind::Vector ? 1 : 0);
    if (field.kind == FieldKind::Vector) {
        // Three numbers beside each other need the whole width.
        grid_->addWidget(label, row - 1, 0, 1, field.pick ? 1 : 2);
        if (field.pick) grid_->addWidget(pickButton(field), row - 1, 1, Qt::AlignRight);
        grid_->addWidget(control, row, 0, 1, 2);
    } else {
        grid_->addWidget(label, row, 0);
        grid_->addWidget(field.formula ? withFormula(field, control, row + 1) : control, row, 1);
    }
    grid_->addWidget(defaultValue, row, 2);
    if (prices_) grid_->addWidget(new PriceTag(*prices_, preferences_, field.name), row + 1, 1, 1, 2);
    if (keys_) keys_->offer(field.name, {label, control});
    refreshers_.push_back([this, &field, label, control, defaultValue] {
        const QString tip =
            tooltipOf(field, preferences_.unit()) + (keys_ ? keys_->tip(field.name) : QString());
        QString text = keys_ ? keys_->mark(field.name) + field.label : field.label;
        // Numbers beside each other have no room for their unit.
        const QString unit = shownOf(field).unit;
        if (field.kind == FieldKind::Vector && !unit.isEmpty())
            text = QStringLiteral("%1 (%2)").arg(text, unit);
        if (field.found && field.found(document_.groom())) text = QString("%1, found").arg(text);
        if (label->text() != text) label->setText(text);
        label->setToolTip(tip);
        control->setToolTip(tip);
        bool isDefault = true;
        for (std::uint32_t c = 0; c < field.components(); ++c) {
            isDefault = isDefault && field.value(document_.groom(), c) == field.defaultValue[c];
        }
        defaultValue->setEnabled(!isDefault);
    });
}

QWidget* FieldForm::pickButton(const Field& field) {
    auto* button = new QPushButton("Pick on head");
    button->setObjectName(QString::fromUtf8(field.name) + "Pick");
    button->setToolTip(
        "Activates the handles: click the head to place the point, or drag it in the viewport");
    connect(button, &QPushButton::clicked, this, [&field] { field.pick(); });
    return button;
}

QWidget* FieldForm::withFormula(const Field& field, QWidget* number, int row) {
    auto* both = new QWidget;
    auto* layout = new QHBoxLayout(both);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(2);
    auto* button = new QToolButton;
    button->setObjectName(QString::fromUtf8(field.name) + "FormulaButton");
    button->setText(QStringLiteral("ƒ"));
    button->setCheckable(true);
    button->setAutoRaise(true);
    button->setToolTip("Use a formula instead of the number: a value for each strand");
    button->setAccessibleName(QString("%1: formula").arg(field.label));
    layout->addWidget(number, 1);
    layout->addWidget(button);
    FormulaEdit* const edit = field.formula();
    edit->hide();
    grid_->addWidget(edit, row, 0, 1, 3);
    connect(button, &QToolButton::clicked, edit, [edit](bool on) {
        edit->setVisible(on);
        if (on) {
            edit->begin();
        } else {
            edit->clear();
        }
    });
    refreshers_.push_back([button, edit, number, was = false]() mutable {
        const bool isSet = edit->isSet();
        number->setEnabled(!isSet);
        if (isSet == was) return;
        was = isSet;
        button->setChecked(isSet);
        // One that was just emptied stays open for the next.
        if (isSet || !edit->isAncestorOf(edit->window()->focusWidget()))
            edit->setVisible(isSet);
        else
            button->setChecked(true);
    });
    return both;
}

Shown FieldForm::shownOf(const Field& field) const {
    return shownAs(QString::fromUtf8(field.unit), field.min, field.max, preferences_.unit());
}

QWidget* FieldForm::makeNumber(const Field& field) {
    auto* box = new NumberBox(field.min, field.max, field.isWhole());
    connect(box, &NumberBox::begun, this, &FieldForm::begin);
    connect(box, &NumberBox::edited, this, [this, &field](double value) { store(field, value); });
    refreshers_.push_back([this, &field, box] {
        const Shown shown = shownOf(field);
        box->setShown(shown.factor, shown.unit, shown.decimals);
        box->setValue(field.value(document_.groom(), 0));
    });
    return box;
}

QWidget* FieldForm::makeGroundTruth(const Field& field) {
    auto* box = new QCheckBox;
    connect(box, &QCheckBox::clicked, this, [this, &field](bool on) {
        begin();
        store(field, on ? 1 : 0);
    });
    refreshers_.push_back([this, &field, box] { box->setChecked(field.value(document_.groom(), 0) != 0); });
    return box;
}

QWidget* FieldForm::makeChoice(const Field& field) {
    auto* box = new QComboBox;
    box->addItems(field.choiceLabels());
    box->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
    box->setMinimumContentsLength(10);
    connect(box, &QComboBox::activated, this, [this, &field](int index) {
        begin();
        store(field, index);
    });
    refreshers_.push_back([this, &field, box] {
        const QSignalBlocker quiet(box);
        if (field.choicesIn) {
            const QStringList choices = field.choicesIn(document_.groom());
            for (int i = 0; i < box->count(); ++i) box->setItemText(i, choices.value(i));
        }
        box->setCurrentIndex(static_cast<int>(field.value(document_.groom(), 0)));
    });
    return box;
}

QWidget* FieldForm::makeVector(const Field& field) {
    auto* widget = new QWidget;
    auto* layout = new QHBoxLayout(widget);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(4);
    for (std::uint32_t c = 0; c < 3; ++c) {
        auto* box = new NumberSpin;
        box->setPrefix(QStringLiteral("XYZ").mid(static_cast<int>(c), 1) + ' ');
        box->setButtonSymbols(QAbstractSpinBox::NoButtons);
        box->setMinimumWidth(60);
        layout->addWidget(box, 1);
        connect(box, &QDoubleSpinBox::valueChanged, this, [this, &field, c](double value) {
            begin();
            store(field, value / shownOf(field).factor, c);
        });
        refreshers_.push_back([this, &field, box, c] {
            const QSignalBlocker quiet(box);
            const Shown shown = shownOf(field);
            // Places anywhere in space are set to the millimetre.
            const bool isPlace = !shown.unit.isEmpty() && field.max - field.min > 100;
            box->setDecimals(isPlace ? std::max(1, shown.decimals - 1) : 2);
            box->setRange(field.min * shown.factor, field.max * shown.factor);
            box->setSingleStep(isPlace ? 0.005 * shown.factor
                                       : std::min(0.05, (field.max - field.min) / 200));
            const auto found = field.found ? field.found(document_.groom()) : std::nullopt;
            const double value = found ? static_cast<double>((*found)[c]) : field.value(document_.groom(), c);
            box->setValue(value * shown.factor);
            if (box->property("found").toBool() == found.has_value()) return;
            box->setProperty("found", found.has_value());
            // The style looks its rules up again.
            box->style()->unpolish(box);
            box->style()->polish(box);
        });
    }
    return widget;
}

QWidget* FieldForm::makeColour(const Field& field) {
    auto* button = new QPushButton;
    button->setProperty("swatch", true);
    const auto colour = [this, &field] {
        const Groom& groom = document_.groom();
        return fromLinear({static_cast<float>(field.value(groom, 0)),
                           static_cast<float>(field.value(groom, 1)),
                           static_cast<float>(field.value(groom, 2))});
    };
    connect(button, &QPushButton::clicked, this, [this, &field, colour] {
        const QColor chosen = QColorDialog::getColor(colour(), this, field.label);
        if (!chosen.isValid()) return;
        begin();
        const Vec3f linear = toLinear(chosen);
        for (std::uint32_t c = 0; c < 3; ++c) store(field, static_cast<double>(linear[c]), c);
    });
    refreshers_.push_back([button, colour] {
        const QColor shown = colour();
        button->setText(shown.name());
        button->setStyleSheet(QStringLiteral("QPushButton { background: %1; color: %2; }")
                                  .arg(shown.name(), shown.lightnessF() > 0.45f ? QStringLiteral("#101010")
                                                                                : QStringLiteral("#f4f4f4")));
    });
    return button;
}

void FieldForm::begin() {
    interaction_ = QtDocument::nextMergeKey();
}

void FieldForm::store(const Field& field, double value, std::uint32_t component) {
    if (field.value(document_.groom(), component) == value) return;
    Groom groom = document_.groom();
    // Who changes one number of what was found keeps the others.
    if (const auto found = field.found ? field.found(groom) : std::nullopt) {
        for (std::uint32_t c = 0; c < field.components(); ++c)
            if (!field.set(groom, static_cast<double>((*found)[c]), c)) return;
    }
    if (!field.set(groom, value, component)) return;
    document_.performMerged(interaction_, [&](const editing::Model& model) {
        if (field.step) return field.step(model, groom);
        return editing::setSettings(model, groom, field.label.toStdString());
    });
}

void FieldForm::refresh(editing::Part parts) {
    if (!contains(parts, shown_)) return;
    for (const auto& refresh : refreshers_) refresh();
}

}  // namespace hairloom::editor
