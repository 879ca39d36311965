// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Shows pictures that were read back, over a reference picture where there is one, with the line that parts
// two looks.

#include <QElapsedTimer>
#include <QImage>
#include <QTimer>
#include <QWidget>
#include <optional>

#include "editor/viewport/mark_sheet.h"

namespace hairloom::editor {

class Canvas : public QWidget {
    Q_OBJECT

  public:
    explicit Canvas(QWidget* parent = nullptr);

    /// Transparent parts show what is behind.
    void setPicture(const QImage& picture);
    const QImage& picture() const { return picture_; }
    void setBackground(const QColor& colour);
    /// Over the picture, at this place in device pixels; a null image: none.
    void setMarks(MarkSheet::Sheet marks);
    /// Behind the picture, as large as fits; null: none. `opacity` 0…1.
    void setReference(const QImage& image, double opacity);
    /// What a picture is waited for, and since when, over what there is; "": nothing. It is said after a
    /// second.
    void setWaiting(const QString& what);
    const QString& waiting() const { return waiting_; }
    /// "Drawing the hair, 3 s", as it is shown now.
    QString waitingWords() const;
    /// Draws the line between two looks at this part of the width; nothing: none.
    void setSplit(std::optional<float> split);

  protected:
    void paintEvent(QPaintEvent* event) override;

  private:
    void paintReference(QPainter& painter) const;
    void paintSplit(QPainter& painter) const;
    void paintWaiting(QPainter& painter) const;

    QImage picture_;
    MarkSheet::Sheet marks_;
    QImage reference_;
    double referenceOpacity_ = 1;
    QColor background_;
    std::optional<float> split_;
    QString waiting_;
    QElapsedTimer since_;
    QTimer tick_;
};

}  // namespace hairloom::editor
