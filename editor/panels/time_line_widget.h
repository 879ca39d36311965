// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What ruler, rows and curves of the time line have in common: its keyboard, zoom and pan, and the line of
// the play head.

#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QWidget>

#include "editor/panels/time_line_view.h"

namespace hairloom::editor {

class TimeLineWidget : public QWidget {
    Q_OBJECT

  public:
    static constexpr int kNames_px = 140;  ///< of the column of names, left of the keys
    static constexpr int kRight_px = 14;   ///< free, so that the last key is whole
    static constexpr double kDragFrom_px = 3;

  protected:
    TimeLineWidget(TimeLineView& view, const char* name, const QString& spoken, QWidget* parent);

    TimeLineView& view() const { return view_; }
    ThemeColours colours() const { return view_.colours(); }
    double toX_px(double time) const;
    double toTime(double x_px) const;
    /// Of the nearest frame, not before 0.
    float toFrameTime(double x_px) const;
    /// Where the keys are, right of the names.
    QRect keysArea() const { return rect().adjusted(kNames_px - kRight_px / 2, 0, 0, 0); }

    // The left button, the only one that derived widgets have a use for.
    virtual void press(QMouseEvent& /*event*/) {}
    virtual void dragged(QMouseEvent& /*event*/) {}
    virtual void release(QMouseEvent& /*event*/) {}
    virtual void hover(QMouseEvent& /*event*/) {}
    /// What is being dragged stays where it was.
    virtual void letGo() {}

    /// Another one where nothing was simulated.
    QColor playHeadColour() const;
    void paintPlayHead(QPainter& painter) const;
    void paintFocus(QPainter& painter) const;

    bool event(QEvent* event) final;
    void keyPressEvent(QKeyEvent* event) final;
    void wheelEvent(QWheelEvent* event) final;
    void mousePressEvent(QMouseEvent* event) final;
    void mouseMoveEvent(QMouseEvent* event) final;
    void mouseReleaseEvent(QMouseEvent* event) final;

  private:
    /// False: a key of the window.
    bool act(const QKeyEvent& event);

    TimeLineView& view_;
    double panFrom_px_ = 0;
};

}  // namespace hairloom::editor
