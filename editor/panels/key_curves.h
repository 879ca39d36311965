// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The values of the current row over time, as curves whose keys are dragged.

#include "editor/panels/time_line_widget.h"

namespace hairloom::editor {

class KeyCurves : public TimeLineWidget {
    Q_OBJECT

  public:
    explicit KeyCurves(TimeLineView& view, QWidget* parent = nullptr);
    QSize sizeHint() const override { return {400, 110}; }
    QSize minimumSizeHint() const override { return {200, 80}; }

    /// Where a number of a key is drawn, in the widget.
    QPointF placeOf(const KeyPlace& key, std::size_t number) const;

  protected:
    void paintEvent(QPaintEvent* event) override;
    void press(QMouseEvent& event) override;
    void dragged(QMouseEvent& event) override;
    void release(QMouseEvent& event) override;
    void hover(QMouseEvent& event) override;
    void letGo() override;
    void mouseDoubleClickEvent(QMouseEvent* event) override;

  private:
    struct Point {
        KeyPlace key;
        std::size_t number;
    };
    struct Range {
        double low, high;
    };
    /// One of the numbers that have a curve, with its points from first to last key.
    struct Curve {
        std::size_t number;
        KeyNumber info;
        Range range;
        QColor colour;
        std::vector<QPointF> points;
    };
    std::vector<Curve> curves() const;
    /// Of all numbers in that unit, with room above and below.
    Range rangeOf(const KeyTrack& track, std::string_view unit) const;
    double toY_px(double value, const Range& range) const;
    std::optional<Point> pointAt(const QPointF& place) const;
    void paintNames(QPainter& painter, const std::vector<Curve>& curves) const;
    void paintCurve(QPainter& painter, const KeyTrack& track, const Curve& curve) const;

    std::optional<Point> held_;
    Range heldRange_{0, 1};  ///< of the curves in the held one's unit, while it is dragged
    QPointF from_;
};

}  // namespace hairloom::editor
