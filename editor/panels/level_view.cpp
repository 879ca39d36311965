// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/panels/level_view.h"

#include <QMouseEvent>
#include <QPainter>
#include <algorithm>
#include <cmath>

namespace hairloom::editor {

LevelView::LevelView(QWidget* parent) : QWidget(parent) {
    setCursor(Qt::SplitHCursor);
}

void LevelView::show(const QImage& strands, const QImage& level) {
    strands_ = strands;
    level_ = level;
    update();
}

QRectF LevelView::picture_px() const {
    if (level_.isNull()) return {};
    double scale = std::min(width() / static_cast<double>(level_.width()),
                            height() / static_cast<double>(level_.height()));
    if (scale >= 1) scale = std::floor(scale);
    const QSizeF size = scale * QSizeF(level_.size());
    return {QPointF(std::floor((width() - size.width()) / 2), std::floor((height() - size.height()) / 2)),
            size};
}

void LevelView::paintEvent(QPaintEvent*) {
    if (level_.isNull()) return;
    QPainter painter(this);
    const QRectF at = picture_px();
    painter.setRenderHint(QPainter::SmoothPixmapTransform, at.width() < level_.width());
    const double line = std::round(at.left() + static_cast<double>(split_) * at.width());
    painter.setClipRect(QRectF(at.left(), at.top(), line - at.left(), at.height()));
    painter.drawImage(at, strands_);
    painter.setClipRect(QRectF(line, at.top(), at.right() - line, at.height()));
    painter.drawImage(at, level_);
    painter.setClipping(false);
    painter.setPen(QPen(QColor(0, 0, 0, 130), 3));
    painter.drawLine(QPointF(line, at.top()), QPointF(line, at.bottom()));
    painter.setPen(QPen(Qt::white, 1));
    painter.drawLine(QPointF(line, at.top()), QPointF(line, at.bottom()));
    const double bottom = at.bottom() - 4;
    const auto word = [&](const QString& text, double left) {
        const QRectF box(left, bottom - 18, fontMetrics().horizontalAdvance(text) + 10, 18);
        painter.setPen(Qt::NoPen);
        painter.setBrush(QColor(30, 32, 36, 200));
        painter.drawRoundedRect(box, 4, 4);
        painter.setPen(Qt::white);
        painter.drawText(box, Qt::AlignCenter, text);
    };
    const QString strands = QString("strands");
    word(strands, line - fontMetrics().horizontalAdvance(strands) - 14);
    word("level", line + 4);
}

void LevelView::mousePressEvent(QMouseEvent* event) {
    mouseMoveEvent(event);
}

void LevelView::mouseMoveEvent(QMouseEvent* event) {
    const QRectF at = picture_px();
    if (at.isEmpty()) return;
    split_ = static_cast<float>(std::clamp((event->position().x() - at.left()) / at.width(), 0.0, 1.0));
    update();
}

}  // namespace hairloom::editor
