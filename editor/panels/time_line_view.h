// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What the widgets of the time line share: which part of it is shown, what is selected, and what is being
// dragged.

#include <QObject>
#include <QPainter>
#include <optional>
#include <vector>

#include "editor/simulation/keying.h"

namespace hairloom::editor {

class TimeLineView : public QObject {
    Q_OBJECT

  public:
    static constexpr int kNames_px = 132;  ///< of the column of names, left of the keys
    static constexpr int kRight_px = 14;   ///< free, so that the last key is whole

    explicit TimeLineView(Keying& keying, QObject* parent = nullptr);

    Keying& keying() const { return keying_; }
    Player& player() const { return keying_.player(); }
    /// With what is being dragged.
    const TimeLine& line() const { return dragged_ ? *dragged_ : keying_.line(); }

    // Seconds across a widget of that width.
    double toX_px(double time, int width) const;
    double toTime(double x_px, int width) const;
    /// Of the nearest frame.
    float toFrameTime(double x_px, int width) const;
    std::int64_t frameOf(double time) const;
    /// All of the range, the pre-roll and the keys.
    void fit();
    /// By a factor, about that time.
    void zoom(double factor, double about);

    const std::vector<KeyPlace>& selection() const { return selection_; }
    bool isSelected(const KeyPlace& key) const;
    void select(std::vector<KeyPlace> keys);
    /// The row that keys of the keyboard and the curves are about; empty where there are no rows.
    std::optional<KeyTrack> current() const;
    void setCurrent(const KeyTrack& track);

    /// Shows another time line until drop() makes it a step of that name, or cancelDrag() forgets it.
    void drag(TimeLine to, std::vector<KeyPlace> selection);
    void drop(const QString& name);
    void cancelDrag();
    bool isDragging() const { return dragged_.has_value(); }

    // Of the selected keys, each a step.

    void removeSelected();
    void copySelectedHere();
    void moveSelected(std::int64_t frames);
    void interpolateSelected(KeyInterpolation interpolation);
    /// The play head to the next key of the current row, or with -1 to the one before, which is selected.
    void goToKey(int direction);

    /// A line where the play head is.
    void paintPlayHead(QPainter& painter, const QRect& area) const;

  Q_SIGNALS:
    void changed();
    /// Someone wants to type the value of the selected key.
    void editRequested();

  private:
    void prune();

    Keying& keying_;
    double first_ = 0, last_ = 4;  ///< seconds that are shown
    TimeLine fitted_;              ///< that fit() has seen
    std::optional<TimeLine> dragged_;
    std::vector<KeyPlace> selection_, selectionBefore_;
    KeyTrack current_;
};

}  // namespace hairloom::editor
