// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The rows of the time line: a diamond for each key, a bar for each clip.

#include <QWidget>

#include "editor/panels/time_line_view.h"

namespace hairloom::editor {

class TrackRows : public QWidget {
    Q_OBJECT

  public:
    explicit TrackRows(TimeLineView& view, QWidget* parent = nullptr);
    QSize sizeHint() const override { return {400, minimumHeight()}; }

    static constexpr int kRow_px = 24;
    /// Middle of a key, or left end of a clip's bar, in the widget; for tests.
    QPoint placeOf(const KeyPlace& key) const;

  protected:
    void paintEvent(QPaintEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void mouseDoubleClickEvent(QMouseEvent* event) override;
    void contextMenuEvent(QContextMenuEvent* event) override;
    void wheelEvent(QWheelEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;
    bool event(QEvent* event) override;

  private:
    enum class Part { body, leftEdge, rightEdge };
    struct Hit {
        KeyPlace key;
        Part part;
    };
    std::optional<Hit> hitAt(const QPointF& place) const;
    QRectF barOf(std::size_t clip) const;
    std::optional<std::size_t> rowAt(double y) const;
    void choose(const KeyPlace& key, Qt::KeyboardModifiers modifiers);
    void dragTo(const QPointF& place);
    void selectInBand();
    void moveRow(int by);
    void refit();

    TimeLineView& view_;
    std::optional<Hit> held_;
    std::vector<KeyPlace> heldKeys_;  ///< selected when the drag began
    QPointF from_;
    std::optional<QRectF> band_;  ///< drawn about keys to select
};

}  // namespace hairloom::editor
