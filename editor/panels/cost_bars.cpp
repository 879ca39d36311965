// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/panels/cost_bars.h"

#include <QPainter>
#include <algorithm>

#include "editor/style/theme.h"

namespace hairloom::editor {

void CostBars::setScale(double budget, double longest) {
    budget_ = budget;
    whole_ = std::max({1.05 * budget, longest, 1e-6});
}

double CostBars::shareOf(double milliseconds) const {
    return std::clamp(milliseconds / whole_, 0.0, 1.0);
}

void CostBars::paint(QPainter* painter, const QStyleOptionViewItem& option, const QModelIndex& index) const {
    const ThemeColours colours = themeColours(preferences_.theme());
    const QRectF cell(option.rect);
    const QVariant milliseconds = index.data(kMilliseconds);
    if (milliseconds.isValid()) {
        const double ms = milliseconds.toDouble();
        QColor fill = ms > budget_ ? colours.bad : colours.accent;
        fill.setAlphaF(0.55f);
        painter->fillRect(
            cell.adjusted(0, 3, 0, -3)
                .intersected(QRectF(cell.left(), cell.top(), cell.width() * shareOf(ms), cell.height())),
            fill);
    }
    const double line = cell.left() + cell.width() * shareOf(budget_);
    painter->setPen(colours.caution);
    painter->drawLine(QPointF(line, cell.top()), QPointF(line, cell.bottom() + 1));
    QStyledItemDelegate::paint(painter, option, index);
}

}  // namespace hairloom::editor
