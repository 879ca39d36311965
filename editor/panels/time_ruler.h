// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The ruler of the time line: frames, the range with its pre-roll, what has played, and the play head.

#include <QWidget>

#include "editor/panels/time_line_view.h"

namespace hairloom::editor {

class TimeRuler : public QWidget {
    Q_OBJECT

  public:
    explicit TimeRuler(TimeLineView& view, QWidget* parent = nullptr);
    QSize sizeHint() const override { return {400, kHeight_px}; }

    static constexpr int kHeight_px = 34;

  protected:
    void paintEvent(QPaintEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void wheelEvent(QWheelEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;
    bool event(QEvent* event) override;

  private:
    void paintFrames(QPainter& painter) const;
    void scrubTo(double x_px);

    TimeLineView& view_;
};

/// Steps the play head: arrows and Page up/down by 1 and 10 frames, Home and End to the range. False: another
/// key.
bool stepByKey(TimeLineView& view, const QKeyEvent& key);
/// Whether the key is one of the time line's, so that it does not run a shortcut of the window.
bool isTimeLineKey(const QKeyEvent& key);

}  // namespace hairloom::editor
