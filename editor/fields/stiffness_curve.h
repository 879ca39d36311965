// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The bending stiffness along the strand as a curve whose ends are dragged. The engine has it change evenly
// from root to tip, so two ends are all there is.

#include <QWidget>

#include "editor/document/document.h"

namespace hairloom::editor {

class StiffnessCurve : public QWidget {
    Q_OBJECT

  public:
    explicit StiffnessCurve(Document& document, QWidget* parent = nullptr);
    QSize sizeHint() const override { return {240, 110}; }
    QSize minimumSizeHint() const override { return {160, 110}; }

    /// Where the handle of the root (0) or the tip (1) stands, in its pixels.
    QPointF handle_px(int end) const;

  protected:
    void paintEvent(QPaintEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;

  private:
    QRectF plot_px() const;

    Document& document_;
    int held_ = -1;      ///< end that is being dragged
    quint64 drags_ = 0;  ///< one drag is one step of the history
};

}  // namespace hairloom::editor
