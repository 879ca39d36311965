// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The diagram of the Accuracy and Levels panels: what each setting costs against how far its hair is from the
// truth, both logarithmic. Diverged settings stand at the upper edge.

#include <QWidget>
#include <optional>
#include <vector>

namespace hairloom::editor {

struct AccuracyPoint {
    double milliseconds = 0;  ///< a frame, or another cost; > 0
    double q1 = 0, q3 = 0;    ///< quartiles of it
    double error = 0;         ///< ≥ 0, in the unit of the axis
    bool diverged = false;    ///< then there is no error
    bool onFront = false;
    QString words;  ///< the setting
};

class AccuracyPlot : public QWidget {
    Q_OBJECT

  public:
    explicit AccuracyPlot(QWidget* parent = nullptr);
    /// What is across and up, in place of milliseconds and errors: "triangles".
    void setAxes(const QString& cost, const QString& costUnit, const QString& error);
    /// `unit` is of errors, "px".
    void setPoints(std::vector<AccuracyPoint> points, const QString& unit);
    /// The one that the document has, and the one that is chosen; marked.
    void setMarked(std::optional<std::size_t> now, std::optional<std::size_t> chosen);
    /// Where a point is drawn.
    QPointF place_px(std::size_t point) const;

  Q_SIGNALS:
    void clicked(std::size_t point);

  protected:
    void paintEvent(QPaintEvent*) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void leaveEvent(QEvent*) override;
    QSize sizeHint() const override { return {300, 220}; }
    QSize minimumSizeHint() const override { return {220, 180}; }

  private:
    struct Span {
        double low = 1, high = 10;
        double shareOf(double value) const;
    };
    QRectF plot_px() const;
    std::optional<std::size_t> pointAt(const QPointF& place_px) const;
    void findSpans();
    void drawAxes(QPainter& painter) const;
    void drawPoint(QPainter& painter, std::size_t point) const;

    std::vector<AccuracyPoint> points_;
    QString cost_ = QString("time a frame"), costUnit_ = "ms", errorName_ = QString("error"), unit_ = "mm";
    Span time_, error_;
    std::optional<std::size_t> now_, chosen_, hovered_;
};

}  // namespace hairloom::editor
