// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/panels/error_bars.h"

#include <QHelpEvent>
#include <QPainter>
#include <QToolTip>
#include <algorithm>

#include "editor/fields/length_text.h"
#include "editor/style/theme.h"

namespace hairloom::editor {
namespace {

constexpr int kGap_px = 6;

QString pixels(double px) {
    constexpr double kNothing_px = 0.001;
    return px < kNothing_px ? QString("< 0.001 px") : QString("%1 px").arg(px, 0, 'g', 2);
}

}  // namespace

ErrorBars::ErrorBars(const Preferences& preferences, QWidget* parent)
    : QWidget(parent), preferences_(preferences) {
    setObjectName("accuracyParts");
    bars_[0].name = QString("Steps");
    bars_[0].meaning =
        QString("difference from the same setting with up to %1 substeps. Use more substeps to reduce it")
            .arg(kConvergedSubsteps);
    bars_[1].name = QString("Points");
    bars_[1].meaning = QString(
        "difference from strands with twice as many points as the finest measured setting. Use more "
        "points to reduce it");
    bars_[2].name = QString("Model");
    bars_[2].meaning = QString(
        "difference between the elastic rod and the finest strands of this model: stretching springs, "
        "contact, single precision, a head sampled once per frame. More substeps or points do not reduce it");
    bars_[3].name = QString("Uncertainty");
    bars_[3].meaning = QString("of the reference (half the steps): smaller differences are noise");
}

void ErrorBars::setParts(const ErrorParts& parts, double doubtMm, double pixelsPerMm) {
    const double mm[kBars] = {parts.step.rmsMm, parts.points.rmsMm, parts.model.rmsMm, doubtMm};
    for (int b = 0; b < kBars; ++b) {
        bars_[b].mm = mm[b];
        bars_[b].px = mm[b] * pixelsPerMm;
    }
    setAccessibleDescription(words());
    update();
}

QString ErrorBars::words() const {
    QStringList words;
    for (const Bar& bar : bars_) words << QString("%1 %2").arg(bar.name, pixels(bar.px));
    return words.join(", ");
}

int ErrorBars::rowHeight() const {
    return fontMetrics().height() + 2;
}

QSize ErrorBars::sizeHint() const {
    return {200, kBars * rowHeight()};
}

void ErrorBars::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    const ThemeColours colours = themeColours(preferences_.theme());
    const QColor fills[kBars] = {colours.accent, colours.caution, colours.bad, colours.dimText};
    int names = 0, numbers = 0;
    double longest = 0;
    for (const Bar& bar : bars_) {
        names = std::max(names, fontMetrics().horizontalAdvance(bar.name));
        numbers = std::max(numbers, fontMetrics().horizontalAdvance(pixels(bar.px)));
        longest = std::max(longest, bar.px);
    }
    const int left = names + kGap_px, room = width() - left - numbers - kGap_px;
    for (int b = 0; b < kBars; ++b) {
        const Bar& bar = bars_[b];
        const int top = b * rowHeight();
        painter.setPen(palette().color(QPalette::Text));
        painter.drawText(QRect(0, top, names, rowHeight()), Qt::AlignLeft | Qt::AlignVCenter, bar.name);
        const double wide = longest > 0 ? std::max(1.0, room * bar.px / longest) : 1;
        painter.fillRect(QRectF(left, top + 3, wide, rowHeight() - 6), fills[b]);
        painter.drawText(QRectF(left + wide + kGap_px, top, numbers + 1, rowHeight()),
                         Qt::AlignLeft | Qt::AlignVCenter, pixels(bar.px));
    }
}

bool ErrorBars::event(QEvent* event) {
    if (event->type() != QEvent::ToolTip) return QWidget::event(event);
    const auto* help = static_cast<QHelpEvent*>(event);
    const Bar& bar = bars_[std::clamp(help->pos().y() / rowHeight(), 0, kBars - 1)];
    QToolTip::showText(
        help->globalPos(),
        QString("%1, %2: %3").arg(bar.name, lengthText(1e-3 * bar.mm, preferences_), bar.meaning), this);
    return true;
}

}  // namespace hairloom::editor
