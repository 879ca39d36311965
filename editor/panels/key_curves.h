// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The values of the current row over time, as curves whose keys are dragged.

#include <QWidget>

#include "editor/panels/time_line_view.h"

namespace hairloom::editor {

class KeyCurves : public QWidget {
    Q_OBJECT

  public:
    explicit KeyCurves(TimeLineView& view, QWidget* parent = nullptr);
    QSize sizeHint() const override { return {400, 110}; }
    QSize minimumSizeHint() const override { return {200, 80}; }

    /// Where a number of a key is drawn, in the widget.
    QPointF placeOf(const KeyPlace& key, std::size_t number) const;

  protected:
    void paintEvent(QPaintEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void mouseDoubleClickEvent(QMouseEvent* event) override;
    void wheelEvent(QWheelEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;
    bool event(QEvent* event) override;

  private:
    struct Point {
        KeyPlace key;
        std::size_t number;
    };
    struct Range {
        double low, high;
    };
    /// Of all numbers in that unit, with room above and below.
    Range rangeOf(const std::string& unit) const;
    double toY_px(double value, const Range& range) const;
    std::optional<Point> pointAt(const QPointF& place) const;
    void paintCurve(QPainter& painter, const KeyTrack& track, std::size_t number, const KeyNumber& info,
                    const QColor& colour) const;

    TimeLineView& view_;
    std::optional<Point> held_;
    Range heldRange_{0, 1};  ///< stays while a key is dragged
    QPointF from_;
};

}  // namespace hairloom::editor
