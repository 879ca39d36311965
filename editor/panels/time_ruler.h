// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The ruler of the time line: frames, the range with its pre-roll, what has played, and the play head.

#include "editor/panels/time_line_widget.h"

namespace hairloom::editor {

class TimeRuler : public TimeLineWidget {
    Q_OBJECT

  public:
    explicit TimeRuler(TimeLineView& view, QWidget* parent = nullptr);
    QSize sizeHint() const override { return {400, kHeight_px}; }

    static constexpr int kHeight_px = 34;

  protected:
    void paintEvent(QPaintEvent* event) override;
    void press(QMouseEvent& event) override;
    void dragged(QMouseEvent& event) override;

  private:
    void paintFrames(QPainter& painter) const;
};

}  // namespace hairloom::editor
