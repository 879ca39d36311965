// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/panels/step_map.h"

#include <QHelpEvent>
#include <QPainter>
#include <QToolTip>
#include <algorithm>
#include <cmath>

#include "editor/style/theme.h"

namespace hairloom::editor {
namespace {

constexpr double kShortest = 1e-4, kLongest = 1.0 / 60;  // seconds, of the map
constexpr int kGap_px = 6;
constexpr double kDot_px = 4.5;

QString milliseconds(double seconds) {
    return QString("%1 ms").arg(1e3 * seconds, 0, 'g', 2);
}

QString wordsOf(const StableStep& row) {
    return QString::fromStdString(row.method + ' ' + failureInWords(row));
}

}  // namespace

StepMap::StepMap(const Preferences& preferences, QWidget* parent)
    : QWidget(parent), preferences_(preferences) {
    setObjectName("stepMap");
}

void StepMap::setGroom(const Groom& groom) {
    step_ = kLongest / groom.simulation.substeps;
    rows_ = stableSteps(groom);
    setAccessibleDescription(words());
    updateGeometry();
    update();
}

QString StepMap::words() const {
    QStringList words;
    QString now;
    for (const StableStep& row : rows_) {
        words << wordsOf(row);
        if (row.isOfGroom)
            now = QString("now %1 at %2").arg(QString::fromStdString(row.method), milliseconds(step_));
    }
    return words.join(", ") + "; " + now;
}

int StepMap::rowHeight() const {
    return fontMetrics().height() + 3;
}

QSize StepMap::sizeHint() const {
    return {240, (static_cast<int>(rows_.size()) + 1) * rowHeight()};
}

void StepMap::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    const ThemeColours colours = themeColours(preferences_.theme());
    int names = 0, numbers = 0;
    for (const StableStep& row : rows_) {
        names = std::max(names, fontMetrics().horizontalAdvance(QString::fromStdString(row.method)));
        numbers = std::max(numbers, fontMetrics().horizontalAdvance(milliseconds(row.longest)));
    }
    const QRectF map(names + kGap_px, 0, width() - names - numbers - 3 * kGap_px, rowHeight());
    const auto across = [&](double seconds) {
        const double share = std::log(seconds / kShortest) / std::log(kLongest / kShortest);
        return map.left() + map.width() * std::clamp(share, 0.0, 1.0);
    };
    int top = 0;
    for (const StableStep& row : rows_) {
        painter.setPen(row.isOfGroom ? colours.text : colours.dimText);
        painter.drawText(QRect(0, top, names, rowHeight()), Qt::AlignLeft | Qt::AlignVCenter,
                         QString::fromStdString(row.method));
        const double border = row.longest > 0 ? across(std::min(row.longest, kLongest)) : map.left();
        const QRectF bar(map.left(), top + 3, map.width(), rowHeight() - 6);
        QColor stable = colours.good, failing = colours.bad;
        if (!row.isOfGroom) {
            stable.setAlphaF(0.45f);
            failing.setAlphaF(0.45f);
        }
        painter.fillRect(QRectF(bar.left(), bar.top(), border - bar.left(), bar.height()), stable);
        painter.fillRect(QRectF(border, bar.top(), bar.right() - border, bar.height()), failing);
        if (std::isfinite(row.longest))
            painter.drawText(QRectF(map.right() + kGap_px, top, numbers + kGap_px, rowHeight()),
                             Qt::AlignLeft | Qt::AlignVCenter, milliseconds(row.longest));
        if (row.isOfGroom) {
            painter.setPen(QPen(colours.viewport, 1.5));
            painter.setBrush(colours.text);
            painter.drawEllipse(QPointF(across(step_), bar.center().y()), kDot_px, kDot_px);
        }
        top += rowHeight();
    }
    painter.setPen(colours.dimText);
    painter.drawText(QRect(0, top, names, rowHeight()), Qt::AlignLeft | Qt::AlignVCenter, "substep");
    double free = map.left();
    for (const double tick : {1e-4, 1e-3, 1e-2}) {
        const QString label = milliseconds(tick);
        const double wide = fontMetrics().horizontalAdvance(label);
        const double x = std::clamp(across(tick) - wide / 2, map.left(), map.right() - wide);
        if (x < free) continue;
        free = x + wide + kGap_px;
        painter.drawText(QRectF(x, top, wide + 1, rowHeight()), Qt::AlignCenter, label);
    }
}

bool StepMap::event(QEvent* event) {
    if (event->type() != QEvent::ToolTip || rows_.empty()) return QWidget::event(event);
    const auto* help = static_cast<QHelpEvent*>(event);
    const std::size_t at =
        std::min(static_cast<std::size_t>(std::max(help->pos().y() / rowHeight(), 0)), rows_.size() - 1);
    const StableStep& row = rows_[at];
    QString words = QString("%1, by linear theory around the rest shape").arg(wordsOf(row));
    if (row.isOfGroom) words += QString(", while the hair has %1").arg(milliseconds(step_));
    QToolTip::showText(help->globalPos(), words, this);
    return true;
}

}  // namespace hairloom::editor
