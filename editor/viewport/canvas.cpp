// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/viewport/canvas.h"

#include <QPainter>
#include <utility>

namespace hairloom::editor {

Canvas::Canvas(QWidget* parent) : QWidget(parent) {
    setAttribute(Qt::WA_OpaquePaintEvent);
    setMouseTracking(true);
    setFocusPolicy(Qt::StrongFocus);
    setAcceptDrops(false);
    constexpr int kTick_ms = 500;
    tick_.setInterval(kTick_ms);
    connect(&tick_, &QTimer::timeout, this, qOverload<>(&QWidget::update));
}

void Canvas::setPicture(const QImage& picture) {
    picture_ = picture;
    update();
}

void Canvas::setBackground(const QColor& colour) {
    background_ = colour;
    update();
}

void Canvas::setMarks(MarkSheet::Sheet marks) {
    if (marks.image.isNull() && marks_.image.isNull()) return;
    marks_ = std::move(marks);
    update();
}

void Canvas::setReference(const QImage& image, double opacity) {
    reference_ = image;
    referenceOpacity_ = opacity;
    update();
}

void Canvas::setWaiting(const QString& what) {
    if (what == waiting_) return;
    waiting_ = what;
    if (what.isEmpty()) {
        tick_.stop();
    } else {
        since_.start();
        tick_.start();
    }
    update();
}

QString Canvas::waitingWords() const {
    constexpr qint64 kSecond_ms = 1000;
    const qint64 seconds = waiting_.isEmpty() ? 0 : since_.elapsed() / kSecond_ms;
    return seconds > 0 ? QString("%1, %L2 s").arg(waiting_).arg(seconds) : QString();
}

void Canvas::setSplit(std::optional<float> split) {
    split_ = split;
    update();
}

void Canvas::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    const bool covers = !picture_.isNull() && !picture_.hasAlphaChannel();
    if (!covers) {
        painter.fillRect(rect(), background_);
        paintReference(painter);
    }
    if (!picture_.isNull()) {
        painter.setRenderHint(QPainter::SmoothPixmapTransform);
        painter.drawImage(rect(), picture_);
    }
    if (!marks_.image.isNull()) {
        const qreal ratio = devicePixelRatioF();
        const QRect& at = marks_.at_px;
        painter.drawImage(QRectF(at.x() / ratio, at.y() / ratio, at.width() / ratio, at.height() / ratio),
                          marks_.image);
    }
    if (split_) paintSplit(painter);
    paintWaiting(painter);
}

void Canvas::paintWaiting(QPainter& painter) const {
    const QString words = waitingWords();
    if (words.isEmpty()) return;
    constexpr int kMargin_px = 12;
    const QRect room = rect().adjusted(kMargin_px, kMargin_px, -kMargin_px, -kMargin_px);
    const int where = picture_.isNull() ? Qt::AlignCenter : Qt::AlignLeft | Qt::AlignBottom;
    painter.setPen(palette().color(QPalette::PlaceholderText));
    painter.drawText(room, where, words);
}

void Canvas::paintReference(QPainter& painter) const {
    if (reference_.isNull()) return;
    const QSizeF fitted = QSizeF(reference_.size()).scaled(size(), Qt::KeepAspectRatio);
    const QPointF corner((width() - fitted.width()) / 2, (height() - fitted.height()) / 2);
    painter.save();
    painter.setRenderHint(QPainter::SmoothPixmapTransform);
    painter.setOpacity(referenceOpacity_);
    painter.drawImage(QRectF(corner, fitted), reference_);
    painter.restore();
}

void Canvas::paintSplit(QPainter& painter) const {
    constexpr int kHandle = 9;
    const double x = static_cast<double>(*split_) * width();
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setPen(QPen(QColor(0, 0, 0, 130), 4));
    painter.drawLine(QPointF(x, 0), QPointF(x, height()));
    painter.setPen(QPen(Qt::white, 1.5));
    painter.drawLine(QPointF(x, 0), QPointF(x, height()));
    painter.setBrush(QColor(30, 32, 36, 220));
    painter.drawEllipse(QPointF(x, height() / 2.0), kHandle, kHandle);
    painter.drawLine(QPointF(x - 4, height() / 2.0), QPointF(x + 4, height() / 2.0));
    const auto badge = [&](double left, const QString& letter) {
        const QRectF box(left, 10, 24, 24);
        painter.setPen(Qt::NoPen);
        painter.drawRoundedRect(box, 5, 5);
        painter.setPen(Qt::white);
        painter.drawText(box, Qt::AlignCenter, letter);
    };
    badge(x - 34, QStringLiteral("A"));
    badge(x + 10, QStringLiteral("B"));
}

}  // namespace hairloom::editor
