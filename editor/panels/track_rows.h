// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The rows of the time line: a diamond for each key, a bar for each clip.

#include "editor/panels/time_line_widget.h"

namespace hairloom::editor {

class TrackRows : public TimeLineWidget {
    Q_OBJECT

  public:
    explicit TrackRows(TimeLineView& view, QWidget* parent = nullptr);
    QSize sizeHint() const override { return {400, minimumHeight()}; }

    static constexpr int kRow_px = 24;
    /// Middle of a key, or left end of a clip's bar, in the widget; for tests.
    QPoint placeOf(const KeyPlace& key) const;

  protected:
    void paintEvent(QPaintEvent* event) override;
    void press(QMouseEvent& event) override;
    void dragged(QMouseEvent& event) override;
    void release(QMouseEvent& event) override;
    void hover(QMouseEvent& event) override;
    void letGo() override;
    void mouseDoubleClickEvent(QMouseEvent* event) override;
    void contextMenuEvent(QContextMenuEvent* event) override;

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
    void refit();
    void paintRow(QPainter& painter, const KeyTrack& track, const QRectF& area) const;
    void paintClip(QPainter& painter, std::size_t clip, double top) const;

    std::optional<Hit> held_;
    std::vector<KeyPlace> heldKeys_;  ///< selected when the drag began
    std::optional<QPointF> from_;     ///< where the button went down
    std::optional<QRectF> band_;      ///< drawn about keys to select
};

}  // namespace hairloom::editor
