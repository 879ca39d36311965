// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// All strands left of a line and a level right of it, both in as many pixels as they have at its distance.

#include <QImage>
#include <QWidget>

namespace hairloom::editor {

class LevelView : public QWidget {
    Q_OBJECT

  public:
    explicit LevelView(QWidget* parent = nullptr);
    /// Of one size; null: nothing.
    void show(const QImage& strands, const QImage& level);
    /// Where the line is, as a part of the picture's width.
    float split() const { return split_; }
    /// Where the picture is; pixels become squares where it is smaller than the widget.
    QRectF picture_px() const;

  protected:
    void paintEvent(QPaintEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    QSize sizeHint() const override { return {300, 300}; }
    QSize minimumSizeHint() const override { return {200, 240}; }

  private:
    QImage strands_, level_;
    float split_ = 0.5f;
};

}  // namespace hairloom::editor
