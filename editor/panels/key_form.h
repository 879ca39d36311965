// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The numbers of the selected key or clip, with their units.

#include <QGridLayout>
#include <QLabel>
#include <QWidget>
#include <functional>

#include "editor/document/preferences.h"
#include "editor/panels/time_line_view.h"

namespace hairloom::editor {

/// Seconds of the clip that play, from first to last. 0: the character has no such clip.
double clipLength(const ClipStrip& strip, const Player& player);
/// Its start, or its end, to `time`: what plays at other times stays. Within what the clip has.
void trimClip(TimeLine& line, std::size_t clip, bool start, double time, const Player& player);

class KeyForm : public QWidget {
    Q_OBJECT

  public:
    KeyForm(TimeLineView& view, const Preferences& preferences, QWidget* parent = nullptr);

    /// The first number has the focus.
    void focus();

  private:
    /// A step that changes the shown key.
    void edit(const std::function<void(TimeLine&)>& write);
    void addFrame();
    std::int64_t shownFrame() const;
    void refresh();
    void rebuild();
    void buildKey(const KeyTrack& track);
    void buildClip();
    void addRow(const QString& label, QWidget* control, const QString& tip);
    QWidget* number(const QString& name, double min, double max, const QString& unit, bool whole,
                    std::function<double(const TimeLine&)> read,
                    std::function<void(TimeLine&, double)> write);
    QWidget* choice(const QString& name, const QStringList& labels, std::function<int(const TimeLine&)> read,
                    std::function<void(TimeLine&, int)> write);
    /// The key that is shown: the last that was selected.
    const KeyPlace& key() const { return view_.selection().back(); }

    TimeLineView& view_;
    const Preferences& preferences_;
    QLabel* none_;
    QWidget* body_ = nullptr;  ///< rows of what is selected
    QGridLayout* grid_ = nullptr;
    QWidget* first_ = nullptr;
    std::optional<KeyTrack> built_;
    std::vector<std::function<void()>> refreshers_;
};

}  // namespace hairloom::editor
