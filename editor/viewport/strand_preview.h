// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Strands and a head as lines, to be turned with mouse and arrows: small, at once, and without the graphics
// device.

#include <QWidget>

#include "core/groom/groom.h"
#include "editor/viewport/orbit_camera.h"

namespace hairloom::editor {

class StrandPreview : public QWidget {
    Q_OBJECT

  public:
    explicit StrandPreview(QWidget* parent = nullptr);
    /// `head` may be null. `spheres` are seen through all else.
    void show(const Groom& strands, std::shared_ptr<const ScalpMesh> head,
              std::vector<CollisionSphere> spheres = {});

    /// Marks the root and the tip of each strand that is drawn.
    void markEnds(bool on) { marksEnds_ = on; }
    static QColor rootColour() { return {80, 200, 120}; }
    static QColor tipColour() { return {235, 90, 80}; }

  protected:
    void paintEvent(QPaintEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;
    void wheelEvent(QWheelEvent* event) override;
    void resizeEvent(QResizeEvent* event) override;

  private:
    void frame();
    void drawSpheres(QPainter& painter) const;
    void drawEnds(QPainter& painter, std::size_t strand) const;
    void drawStrand(QPainter& painter, std::size_t strand) const;
    QPolygonF projected(std::span<const Vec3f> points) const;

    Groom strands_;
    std::shared_ptr<const ScalpMesh> head_;
    std::vector<CollisionSphere> spheres_;
    bool marksEnds_ = false;
    OrbitCamera camera_;
    QPointF last_px_;
};

}  // namespace hairloom::editor
