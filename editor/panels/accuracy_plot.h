// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The diagram of the Accuracy panel: what each setting costs against how far its hair is from the truth, both
// logarithmic. Diverged settings stand at the upper edge. That of the Levels panel has distances across.

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
    QString words;         ///< the setting
    std::size_t line = 0;  ///< where lines are drawn for all: the one that it is on
};

class AccuracyPlot : public QWidget {
    Q_OBJECT

  public:
    explicit AccuracyPlot(QWidget* parent = nullptr);
    /// What is across and up, in place of milliseconds and errors: "triangles".
    void setAxes(const QString& cost, const QString& costUnit, const QString& error);
    /// Joins points of a line, and not only those on the front. The line on the front stands out.
    void setLines(bool on) { lines_ = on; }
    /// `unit` is of errors, "px".
    void setPoints(std::vector<AccuracyPoint> points, const QString& unit);
    /// The one that the document has, and the one that is chosen; marked.
    void setMarked(std::optional<std::size_t> now, std::optional<std::size_t> chosen);
    const std::vector<AccuracyPoint>& points() const { return points_; }
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
    void drawLine(QPainter& painter, std::vector<std::size_t> points) const;
    void drawPoint(QPainter& painter, std::size_t point) const;
    QColor colourOf(const AccuracyPoint& point) const;

    std::vector<AccuracyPoint> points_;
    QString cost_ = QString("time a frame"), costUnit_ = "ms", errorName_ = QString("error"), unit_ = "mm";
    bool lines_ = false;
    Span time_, error_;
    std::optional<std::size_t> now_, chosen_, hovered_;
};

}  // namespace hairloom::editor
