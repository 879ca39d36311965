// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/dialogs/strand_preview.h"

#include <QMouseEvent>
#include <QPainter>
#include <cmath>

namespace hairloom::editor {
namespace {

constexpr std::size_t kMostStrands = 3000;

}  // namespace

StrandPreview::StrandPreview(QWidget* parent) : QWidget(parent) {
    setMinimumSize(320, 320);
    setToolTip(tr("Drag to turn, wheel to zoom"));
}

void StrandPreview::show(const Groom& strands, std::shared_ptr<const ScalpMesh> head) {
    strands_ = strands;
    head_ = std::move(head);
    frame();
}

void StrandPreview::frame() {
    Box3f box = strands_.bounds();
    if (head_) box.extend(head_->bounds());
    camera_.frame(box, static_cast<float>(width()) / static_cast<float>(std::max(height(), 1)));
    update();
}

QPolygonF StrandPreview::projected(std::span<const Vec3f> points) const {
    QPolygonF line;
    for (const Vec3f& point : points) {
        if (const auto at = camera_.project(point, size())) line.append(*at);
    }
    return line;
}

void StrandPreview::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    painter.fillRect(rect(), palette().color(QPalette::Base));
    painter.setRenderHint(QPainter::Antialiasing);
    if (head_) {
        painter.setPen(Qt::NoPen);
        QColor skin = palette().color(QPalette::Mid);
        for (std::uint32_t t = 0; t < head_->triangleCount(); ++t) {
            const float facing = -head_->triangleNormal(t).dot(camera_.forward_ws());
            if (facing <= 0) continue;
            std::array<Vec3f, 3> corners;
            for (std::size_t i = 0; i < 3; ++i) corners[i] = head_->positions()[head_->triangles()[t][i]];
            painter.setBrush(skin.darker(static_cast<int>(100 + 60 * (1 - facing))));
            painter.drawPolygon(projected(corners));
        }
    }
    QColor hair = palette().color(QPalette::Highlight);
    hair.setAlpha(150);
    painter.setPen(QPen(hair, 1));
    const std::size_t stride = std::max<std::size_t>(1, strands_.strandCount() / kMostStrands);
    for (std::size_t s = 0; s < strands_.strandCount(); s += stride) {
        painter.drawPolyline(projected(strands_.strand(s)));
    }
}

void StrandPreview::mousePressEvent(QMouseEvent* event) {
    last_px_ = event->position();
}
void StrandPreview::mouseMoveEvent(QMouseEvent* event) {
    camera_.turn(event->position() - last_px_);
    last_px_ = event->position();
    update();
}
void StrandPreview::wheelEvent(QWheelEvent* event) {
    camera_.zoom(std::exp(0.0012f * static_cast<float>(event->angleDelta().y())));
    update();
}
void StrandPreview::resizeEvent(QResizeEvent* event) {
    QWidget::resizeEvent(event);
    frame();
}

}  // namespace hairloom::editor
