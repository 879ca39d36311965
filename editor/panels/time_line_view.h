// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What the widgets of the time line share: which part of it is shown, what is selected, and what is being
// dragged.

#include <QObject>
#include <optional>
#include <set>
#include <vector>

#include "editor/document/preferences.h"
#include "editor/simulation/keying.h"
#include "editor/style/theme.h"

namespace hairloom::editor {

class TimeLineView : public QObject {
    Q_OBJECT

  public:
    TimeLineView(Keying& keying, const Preferences& preferences, QObject* parent = nullptr);

    Keying& keying() const { return keying_; }
    Player& player() const { return keying_.player(); }
    DisplayUnit lengths() const { return preferences_.unit(); }
    ThemeColours colours() const { return themeColours(preferences_.theme()); }
    /// With what is being dragged.
    const TimeLine& line() const { return dragged_ ? *dragged_ : keying_.line(); }
    std::int64_t frameOf(double time) const;

    // Seconds that are shown.
    double first() const { return first_; }
    double last() const { return last_; }
    /// All of the range, the pre-roll and the keys.
    void fit();
    /// By a factor, about that time.
    void zoom(double factor, double about);
    /// By seconds.
    void pan(double by);

    const std::vector<KeyPlace>& selection() const { return selection_; }
    bool isSelected(const KeyPlace& key) const;
    /// The last of them is the one whose values are shown.
    void select(std::vector<KeyPlace> keys);
    void selectAll();
    /// The row that keys of the keyboard and the curves are about; empty where there are no rows.
    std::optional<KeyTrack> current() const;
    void setCurrent(const KeyTrack& track);
    /// The one that is so many rows below.
    void moveRow(int by);

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
    /// Where there is none, with the value that the row has there; a clip cannot be. It is selected.
    void insertKey(const KeyTrack& track, float time);
    /// The play head to the next key of the current row, or with -1 to the one before, which is selected.
    void goToKey(int direction);

  Q_SIGNALS:
    void changed();
    /// What is being dragged is no longer there.
    void interrupted();
    /// Someone wants to type the value of the selected key.
    void editRequested();

  private:
    /// That it has changed, without selected keys that are gone.
    void announce();
    void prune();
    void setSelection(std::vector<KeyPlace> keys);
    /// Where the play head is moved to is seen.
    void reveal(double time);

    Keying& keying_;
    const Preferences& preferences_;
    double first_ = 0, last_ = 4;
    TimeLine fitted_;  ///< its range is the one that fit() has seen
    std::optional<TimeLine> dragged_;
    std::vector<KeyPlace> selection_, selectionBefore_;
    std::set<KeyPlace> selected_;  ///< the same
    KeyTrack current_;
};

}  // namespace hairloom::editor
