// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/viewport/strand_preview.h"

#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>
#include <algorithm>
#include <cmath>

namespace hairloom::editor {
namespace {

constexpr std::size_t kMaxStrands = 3000;

}  // namespace

StrandPreview::StrandPreview(QWidget* parent) : QWidget(parent) {
    setMinimumSize(320, 320);
    setFocusPolicy(Qt::StrongFocus);
    setAccessibleName("Preview");
    setToolTip("Drag or arrow keys to turn, wheel or + and − to zoom");
}

void StrandPreview::show(const Groom& strands, std::shared_ptr<const ScalpMesh> head,
                         std::vector<CollisionSphere> spheres) {
    strands_ = strands;
    head_ = std::move(head);
    spheres_ = std::move(spheres);
    frame();
}

void StrandPreview::frame() {
    Box3f box = strands_.bounds();
    if (head_) box.extend(head_->bounds());
    for (const CollisionSphere& sphere : spheres_) {
        box.extend(Vec3f(sphere.centre + Vec3f::Constant(sphere.radius)));
        box.extend(Vec3f(sphere.centre - Vec3f::Constant(sphere.radius)));
    }
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
    if (head_) {
        // Without antialiasing, which would leave seams between the faces.
        painter.setPen(Qt::NoPen);
        const QColor skin(196, 160, 138);
        for (std::uint32_t t = 0; t < head_->triangleCount(); ++t) {
            const float facing = -head_->triangleNormal(t).dot(camera_.forward_ws());
            if (facing <= 0) continue;
            std::array<Vec3f, 3> corners;
            for (std::size_t i = 0; i < 3; ++i) corners[i] = head_->positions()[head_->triangles()[t][i]];
            painter.setBrush(skin.darker(static_cast<int>(100 + 90 * (1 - facing))));
            painter.drawPolygon(projected(corners));
        }
    }
    painter.setRenderHint(QPainter::Antialiasing);
    // Far strands first; those on the far side of the head are hidden by it only where they lie behind its
    // middle.
    const std::size_t stride = std::max<std::size_t>(1, strands_.strandCount() / kMaxStrands);
    std::vector<std::pair<float, std::size_t>> order;
    for (std::size_t s = 0; s < strands_.strandCount(); s += stride) {
        const auto points = strands_.strand(s);
        order.emplace_back(-points[points.size() / 2].dot(camera_.forward_ws()), s);
    }
    std::ranges::sort(order);
    for (const auto& [depth, s] : order) drawStrand(painter, s);
    constexpr std::size_t kMostMarks = 400;
    const std::size_t apart = std::max<std::size_t>(1, order.size() / kMostMarks);
    for (std::size_t i = 0; marksEnds_ && i < order.size(); i += apart) drawEnds(painter, order[i].second);
    drawSpheres(painter);
    if (!hasFocus()) return;
    painter.setPen(QPen(palette().color(QPalette::Highlight), 2));
    painter.setBrush(Qt::NoBrush);
    painter.drawRect(rect().adjusted(1, 1, -1, -1));
}

void StrandPreview::drawEnds(QPainter& painter, std::size_t strand) const {
    constexpr double kRadius_px = 2.5;
    const auto points = strands_.strand(strand);
    painter.setPen(Qt::NoPen);
    for (const auto& [point, colour] :
         {std::pair(points.back(), tipColour()), std::pair(points.front(), rootColour())}) {
        const auto at = camera_.project(point, size());
        if (!at) continue;
        painter.setBrush(colour);
        painter.drawEllipse(*at, kRadius_px, kRadius_px);
    }
}

void StrandPreview::drawSpheres(QPainter& painter) const {
    // As the viewport marks a sphere.
    const QColor rim(255, 200, 80);
    QColor inside = rim;
    inside.setAlphaF(0.12f);
    painter.setPen(QPen(rim, 1.5));
    painter.setBrush(inside);
    for (const CollisionSphere& sphere : spheres_) {
        const auto middle = camera_.project(sphere.centre, size());
        if (!middle) continue;
        const double radius_px = static_cast<double>(sphere.radius) /
                                 static_cast<double>(camera_.metresPerPixel(sphere.centre, size()));
        painter.drawEllipse(*middle, radius_px, radius_px);
    }
}

void StrandPreview::drawStrand(QPainter& painter, std::size_t strand) const {
    // Kajiya and Kay's highlight of a light beside the eye, on brown.
    const Vec3f toLight = (Vec3f(0, 0.7f, 0) - camera_.forward_ws() - 0.4f * camera_.right_ws()).normalized();
    const auto points = strands_.strand(strand);
    for (std::size_t p = 1; p < points.size(); ++p) {
        const auto a = camera_.project(points[p - 1], size()), b = camera_.project(points[p], size());
        if (!a || !b) continue;
        const float along = (points[p] - points[p - 1]).normalized().dot(toLight);
        const float across = std::sqrt(std::max(0.0f, 1 - along * along));
        const float bright = 0.25f + 0.4f * across + 0.5f * std::pow(across, 24.0f);
        const auto tone = [bright](float full) { return std::min(1.0f, full * bright); };
        painter.setPen(QPen(QColor::fromRgbF(tone(0.62f), tone(0.42f), tone(0.27f), 0.8f), 1));
        painter.drawLine(*a, *b);
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
void StrandPreview::keyPressEvent(QKeyEvent* event) {
    constexpr double kTurn_px = 40;
    constexpr float kZoom = 1.2f;
    switch (event->key()) {
        case Qt::Key_Left:
            camera_.turn({-kTurn_px, 0});
            break;
        case Qt::Key_Right:
            camera_.turn({kTurn_px, 0});
            break;
        case Qt::Key_Up:
            camera_.turn({0, -kTurn_px});
            break;
        case Qt::Key_Down:
            camera_.turn({0, kTurn_px});
            break;
        case Qt::Key_Plus:
        case Qt::Key_Equal:
            camera_.zoom(kZoom);
            break;
        case Qt::Key_Minus:
            camera_.zoom(1 / kZoom);
            break;
        default:
            return QWidget::keyPressEvent(event);
    }
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
