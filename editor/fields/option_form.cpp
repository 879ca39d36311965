// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/fields/option_form.h"

#include <QCheckBox>
#include <QComboBox>

#include "editor/fields/field.h"
#include "editor/fields/number_box.h"
#include "editor/fields/price_tag.h"

namespace hairloom::editor {

OptionForm::OptionForm(const Preferences& preferences, const Prices* prices, QWidget* parent)
    : QWidget(parent), preferences_(preferences), prices_(prices), layout_(new QFormLayout(this)) {
    layout_->setContentsMargins(0, 0, 0, 0);
    layout_->setHorizontalSpacing(10);
    layout_->setVerticalSpacing(5);
    layout_->setFieldGrowthPolicy(QFormLayout::AllNonFixedFieldsGrow);
    connect(&preferences_, &Preferences::changed, this, &OptionForm::refresh);
}

void OptionForm::addNumber(const QString& name, const QString& label, const QString& tip, const QString& unit,
                           double min, double max, bool whole, std::function<double()> get,
                           std::function<void(double)> set) {
    auto* box = new NumberBox(min, max, whole);
    box->setObjectName(name);
    connect(box, &NumberBox::edited, this, [set = std::move(set)](double value) { set(value); });
    refreshers_.push_back([this, box, label, tip, unit, min, max, get = std::move(get)] {
        const Shown shown = shownAs(unit, min, max, preferences_.unit());
        box->setShown(shown.factor, shown.unit, shown.decimals);
        box->setValue(get());
        box->setToolTip(QString("<p><b>%1</b></p><p>%2</p><p>%3 to %4 %5</p>")
                            .arg(label, tip, QString::number(min * shown.factor, 'g', 5),
                                 QString::number(max * shown.factor, 'g', 5), shown.unit));
    });
    refreshers_.back()();
    addPriced(name, label, box);
}

void OptionForm::addBool(const QString& name, const QString& label, const QString& tip,
                         std::function<bool()> get, std::function<void(bool)> set) {
    auto* box = new QCheckBox(label);
    box->setObjectName(name);
    box->setToolTip(tip);
    connect(box, &QCheckBox::clicked, this, [set = std::move(set)](bool on) { set(on); });
    refreshers_.push_back([box, get = std::move(get)] { box->setChecked(get()); });
    refreshers_.back()();
    layout_->addRow(QString(), box);
}

void OptionForm::addChoice(const QString& name, const QString& label, const QString& tip,
                           const QStringList& choices, std::function<int()> get,
                           std::function<void(int)> set) {
    addChoice(
        name, label, tip, [choices] { return choices; }, std::move(get), std::move(set));
}

void OptionForm::addChoice(const QString& name, const QString& label, const QString& tip,
                           std::function<QStringList()> choices, std::function<int()> get,
                           std::function<void(int)> set) {
    auto* box = new QComboBox;
    box->setObjectName(name);
    box->setToolTip(tip);
    box->addItems(choices());
    connect(box, &QComboBox::activated, this, [set = std::move(set)](int index) { set(index); });
    refreshers_.push_back([box, choices = std::move(choices), get = std::move(get)] {
        const QStringList now = choices();
        for (int i = 0; i < box->count(); ++i) box->setItemText(i, now.value(i));
        box->setCurrentIndex(get());
    });
    refreshers_.back()();
    addPriced(name, label, box);
}

void OptionForm::addPriced(const QString& name, const QString& label, QWidget* control) {
    layout_->addRow(label, control);
    if (prices_) layout_->addRow(QString(), new PriceTag(*prices_, preferences_, name));
}

void OptionForm::addWidget(const QString& label, QWidget* widget) {
    layout_->addRow(label, widget);
}

void OptionForm::refresh() {
    for (const auto& refresh : refreshers_) refresh();
}

}  // namespace hairloom::editor
