// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/fields/number_box.h"

#include <QHBoxLayout>
#include <QKeyEvent>
#include <QSignalBlocker>
#include <algorithm>
#include <cmath>

namespace hairloom::editor {
namespace {

constexpr int kSteps = 1000;
constexpr double kLogarithmicSpan = 1000;

/// Smallest value above 0 that a logarithmic slider tells apart.
double floorOf(double min, double max) {
    return std::max(min, max / 1e5);
}

bool isLogarithmic(double min, double max) {
    const bool isWide = min >= 0 && max / std::max(min, max / 1e9) > kLogarithmicSpan;
    // Those that begin at 0 do so for small numbers, which a logarithm would crowd out.
    return isWide && (min > 0 || max > 20);
}

}  // namespace

NumberBox::NumberBox(double min, double max, bool whole, QWidget* parent)
    : QWidget(parent),
      min_(min),
      max_(max),
      whole_(whole),
      slider_(new QSlider(Qt::Horizontal)),
      spin_(new NumberSpin) {
    auto* layout = new QHBoxLayout(this);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(6);
    // The number has what it needs first, the slider what is left.
    constexpr int kMuch = 100;
    layout->addWidget(slider_, 1);
    layout->addWidget(spin_, kMuch);
    slider_->setRange(0, kSteps);
    slider_->setMinimumWidth(20);
    slider_->setFocusPolicy(Qt::ClickFocus);
    spin_->setMinimumWidth(70);
    spin_->setMaximumWidth(86);
    spin_->setAlignment(Qt::AlignRight);
    setFocusProxy(spin_);
    spin_->installEventFilter(this);
    setShown(1, {}, whole ? 0 : 2);

    connect(slider_, &QSlider::sliderPressed, this, &NumberBox::begun);
    connect(slider_, &QSlider::valueChanged, this, [this](int position) {
        if (!slider_->isSliderDown()) Q_EMIT begun();
        value_ = fromSlider(position);
        const QSignalBlocker quiet(spin_);
        spin_->setValue(value_ * factor_);
        Q_EMIT edited(value_);
    });
    connect(spin_, &QDoubleSpinBox::valueChanged, this, [this](double shown) {
        Q_EMIT begun();
        value_ = std::clamp(shown / factor_, min_, max_);
        const QSignalBlocker quiet(slider_);
        slider_->setValue(toSlider(value_));
        Q_EMIT edited(value_);
    });
}

bool NumberBox::eventFilter(QObject* watched, QEvent* event) {
    if (watched != spin_ || event->type() != QEvent::KeyPress) return QWidget::eventFilter(watched, event);
    // The keys of tools are theirs again once a number is typed, or given up.
    switch (static_cast<QKeyEvent*>(event)->key()) {
        case Qt::Key_Escape:
            showValue();
            spin_->clearFocus();
            return true;
        case Qt::Key_Return:
        case Qt::Key_Enter:
            spin_->interpretText();
            spin_->clearFocus();
            return true;
        default:
            return QWidget::eventFilter(watched, event);
    }
}

void NumberBox::setShown(double factor, const QString& unit, int decimals) {
    factor_ = factor;
    const QSignalBlocker quiet(spin_);
    spin_->setDecimals(whole_ ? 0 : decimals);
    spin_->setRange(min_ * factor, max_ * factor);
    spin_->setSuffix(unit.isEmpty() ? QString() : QStringLiteral(" ") + unit);
    spin_->setSingleStep(whole_ ? 1 : std::max(std::pow(10.0, -decimals), (max_ - min_) * factor / 100));
    // What spans thousands has no step that fits all of it.
    spin_->setStepType(isLogarithmic(min_, max_) && !whole_ ? QAbstractSpinBox::AdaptiveDecimalStepType
                                                            : QAbstractSpinBox::DefaultStepType);
    showValue();
}

void NumberBox::setValue(double value) {
    value_ = value;
    showValue();
}

void NumberBox::showValue() {
    const QSignalBlocker quietSpin(spin_);
    const QSignalBlocker quietSlider(slider_);
    spin_->setValue(value_ * factor_);
    if (!slider_->isSliderDown()) slider_->setValue(toSlider(value_));
}

double NumberBox::fromSlider(int position) const {
    const double share = static_cast<double>(position) / kSteps;
    double value = min_ + share * (max_ - min_);
    if (isLogarithmic(min_, max_)) {
        const double low = floorOf(min_, max_);
        value = position == 0 ? min_ : low * std::pow(max_ / low, share);
    }
    return whole_ ? std::round(value) : value;
}

int NumberBox::toSlider(double value) const {
    double share = max_ > min_ ? (value - min_) / (max_ - min_) : 0;
    if (isLogarithmic(min_, max_)) {
        const double low = floorOf(min_, max_);
        share = value <= low ? 0 : std::log(value / low) / std::log(max_ / low);
    }
    return static_cast<int>(std::lround(std::clamp(share, 0.0, 1.0) * kSteps));
}

}  // namespace hairloom::editor
