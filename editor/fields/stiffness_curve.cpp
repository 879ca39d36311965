// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/fields/stiffness_curve.h"

#include <QMouseEvent>
#include <QPainter>
#include <algorithm>
#include <cmath>

namespace hairloom::editor {

StiffnessCurve::StiffnessCurve(Document& document, QWidget* parent) : QWidget(parent), document_(document) {
    setObjectName("stiffnessCurve");
    setMouseTracking(true);
    setToolTip(
        tr("<p><b>Stiffness from root to tip</b></p><p>Drag the left end for the root, the right end for the "
           "tip. 0 is off, 0.5 real hair, 1 rigid; the tip is at most as stiff as the root.</p>"));
    connect(&document_, &Document::changed, this, [this](Changes changes) {
        if (changes & Change::Simulation) update();
    });
}

QRectF StiffnessCurve::plot_px() const {
    return QRectF(rect()).adjusted(34, 8, -10, -22);
}

QPointF StiffnessCurve::handle_px(int end) const {
    const auto& settings = document_.groom().simulation;
    const float stiffness = settings.angularStiffness * (end == 0 ? 1.0f : settings.angularTipShare);
    const QRectF plot = plot_px();
    return {end == 0 ? plot.left() : plot.right(),
            plot.bottom() - plot.height() * static_cast<double>(stiffness)};
}

void StiffnessCurve::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    const QRectF plot = plot_px();
    const QColor dim = palette().color(QPalette::PlaceholderText);
    painter.fillRect(plot, palette().color(QPalette::Base));
    for (const double level : {0.0, 0.5, 1.0}) {
        const double y = plot.bottom() - level * plot.height();
        painter.setPen(palette().color(QPalette::Mid));
        painter.drawLine(QPointF(plot.left(), y), QPointF(plot.right(), y));
        painter.setPen(dim);
        painter.drawText(QRectF(0, y - 8, plot.left() - 7, 16), Qt::AlignRight | Qt::AlignVCenter,
                         QString::number(level, 'g', 2));
    }
    painter.drawText(QRectF(plot.left(), plot.bottom() + 4, plot.width(), 18), Qt::AlignLeft, tr("Root"));
    painter.drawText(QRectF(plot.left(), plot.bottom() + 4, plot.width(), 18), Qt::AlignRight, tr("Tip"));
    const QPointF root = handle_px(0), tip = handle_px(1);
    QColor fill = palette().color(QPalette::Highlight);
    painter.setPen(Qt::NoPen);
    fill.setAlpha(60);
    painter.setBrush(fill);
    painter.drawPolygon(QPolygonF{plot.bottomLeft(), root, tip, plot.bottomRight()});
    painter.setPen(QPen(palette().color(QPalette::Highlight), 2));
    painter.drawLine(root, tip);
    painter.setPen(QPen(palette().color(QPalette::Highlight), 1.5));
    painter.setBrush(palette().color(QPalette::Text));
    for (const QPointF& at : {root, tip}) painter.drawEllipse(at, 5, 5);
}

void StiffnessCurve::mousePressEvent(QMouseEvent* event) {
    const QPointF at = event->position();
    held_ = std::abs(at.x() - handle_px(0).x()) < std::abs(at.x() - handle_px(1).x()) ? 0 : 1;
    ++drags_;
    mouseMoveEvent(event);
}

void StiffnessCurve::mouseMoveEvent(QMouseEvent* event) {
    if (held_ < 0) {
        const bool over = (event->position() - handle_px(0)).manhattanLength() < 14 ||
                          (event->position() - handle_px(1)).manhattanLength() < 14;
        setCursor(over ? Qt::SizeVerCursor : Qt::ArrowCursor);
        return;
    }
    const QRectF plot = plot_px();
    const auto level =
        static_cast<float>(std::clamp((plot.bottom() - event->position().y()) / plot.height(), 0.0, 1.0));
    Groom groom = document_.groom();
    auto& settings = groom.simulation;
    if (held_ == 0) {
        // The tip stays where it is as far as it can.
        const float tip = settings.angularStiffness * settings.angularTipShare;
        settings.angularStiffness = level;
        settings.angularTipShare = level > 0 ? std::min(1.0f, tip / level) : settings.angularTipShare;
    } else if (settings.angularStiffness > 0) {
        settings.angularTipShare = std::min(1.0f, level / settings.angularStiffness);
    }
    if (settings == document_.groom().simulation) return;
    constexpr quint64 kKey = quint64{0x63757276} << 32u;
    document_.change(tr("Stiffness curve"), Change::Simulation, std::move(groom), kKey + drags_);
}

void StiffnessCurve::mouseReleaseEvent(QMouseEvent*) {
    held_ = -1;
}

}  // namespace hairloom::editor
