// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A curve from root to tip whose keys are dragged, added and removed.

#include <QWidget>
#include <optional>

#include "hairloom/ramp.h"

namespace hairloom::editor {

class RampEdit : public QWidget {
    Q_OBJECT

  public:
    explicit RampEdit(QWidget* parent = nullptr);
    QSize sizeHint() const override { return {240, 120}; }
    QSize minimumSizeHint() const override { return {160, 120}; }

    /// Shows it; a key that is held stays held where there are as many keys as before.
    void setRamp(const runtime::Ramp& ramp);
    const runtime::Ramp& ramp() const { return ramp_; }
    /// Where a key stands, in pixels of the widget.
    QPointF handle_px(std::uint32_t key) const;

  Q_SIGNALS:
    void begun();  ///< of each drag, step of a key or removal
    void edited(const runtime::Ramp& ramp);

  protected:
    void paintEvent(QPaintEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;
    /// Keeps Delete from the window's shortcuts.
    bool event(QEvent* event) override;

  private:
    QRectF plot_px() const;
    QPointF toPlot_px(float at, float value) const;
    /// The place along the curve at a pixel, below 0 and above 1 beside the plot.
    float along(const QPointF& place_px) const;
    std::optional<std::uint32_t> keyAt(const QPointF& place_px) const;
    /// Over the curve between two keys, where one more has room.
    bool mayAddAt(const QPointF& place_px) const;
    void addKey(const QPointF& place_px);
    /// The ends stay.
    void removeKey(std::uint32_t key);
    /// As far as the keys beside it and the range allow.
    void moveKey(std::uint32_t key, float at, float value);
    void drawGrid(QPainter& painter) const;
    void drawCurve(QPainter& painter) const;

    runtime::Ramp ramp_;
    std::uint32_t chosen_ = 0;  ///< key that was touched last
    bool held_ = false;
};

}  // namespace hairloom::editor
