// SPDX-License-Identifier: GPL-3.0-or-later
// The time line below the view: play head, range, keys and clips.
#include <QCheckBox>
#include <QComboBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QMenu>
#include <QScrollArea>
#include <QStackedWidget>
#include <QToolButton>
#include <QVBoxLayout>
#include <map>

#include "core/animation/actor.h"
#include "core/groom/poses.h"
#include "editor/document/words.h"
#include "editor/fields/blocks.h"
#include "editor/fields/number_spin.h"
#include "editor/panels/key_curves.h"
#include "editor/panels/key_form.h"
#include "editor/panels/panel.h"
#include "editor/panels/time_ruler.h"
#include "editor/panels/track_rows.h"
#include "editor/style/icons.h"

namespace hairloom::editor {
namespace {

constexpr int kForm_px = 226;

class TimeLinePanel : public QWidget {
  public:
    explicit TimeLinePanel(const PanelParts& parts)
        : player_(parts.player),
          keying_(parts.keying),
          viewport_(parts.viewport),
          view_(new TimeLineView(parts.keying, parts.preferences, this)),
          form_(new KeyForm(*view_, parts.preferences)) {
        auto* layout = new QVBoxLayout(this);
        layout->setContentsMargins(8, 4, 8, 6);
        layout->setSpacing(4);
        addTransport(*layout);
        addRange(*layout, parts.actions);
        auto* across = new QHBoxLayout;
        across->setSpacing(8);
        across->addWidget(makeTracks(), 1);
        auto* form = new QScrollArea;
        form->setObjectName("keyFormArea");
        form->setWidgetResizable(true);
        form->setFrameShape(QFrame::NoFrame);
        form->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
        form->setWidget(form_);
        form->setFixedWidth(kForm_px);
        formArea_ = form;
        across->addWidget(form);
        layout->addLayout(across, 1);
        connect(view_, &TimeLineView::changed, this, &TimeLinePanel::refresh);
        connect(view_, &TimeLineView::editRequested, this, [this] { form_->focus(); });
        connect(&player_, &Player::motionsChanged, this, &TimeLinePanel::refresh);
        connect(&viewport_, &Viewport::poseChanged, this, [this] { showState(); });
        refresh();
    }

  private:
    QToolButton* button(const char* name, const char* iconName, const QString& text, const QString& tip,
                        std::function<void()> act) {
        auto* made = new QToolButton;
        made->setObjectName(name);
        if (hasIcon(iconName)) {
            made->setIcon(icon(iconName));
            made->setAccessibleName(text);
        } else {
            made->setText(text);
        }
        made->setToolTip(tip);
        made->setFocusPolicy(Qt::StrongFocus);
        connect(made, &QToolButton::clicked, this, [act = std::move(act)] { act(); });
        return made;
    }

    QToolButton* menuButton(const char* name, const QString& text, const QString& tip) {
        auto* made = button(name, "", text + " ▾", tip, [] {});
        made->setAccessibleName(text);
        made->setPopupMode(QToolButton::InstantPopup);
        made->setProperty("role", "menu");
        auto* menu = new QMenu(made);
        menu->setObjectName(QString(name) + "Menu");
        made->setMenu(menu);
        return made;
    }

    /// A number of frames or frames a second.
    NumberSpin* spin(const char* name, const QString& label, QHBoxLayout& row, double max, int decimals,
                     const QString& tip, std::function<void(double)> set) {
        auto* words = new QLabel(label);
        auto* made = new NumberSpin;
        made->setObjectName(name);
        made->setDecimals(decimals);
        made->setRange(0, max);
        made->setButtonSymbols(QAbstractSpinBox::NoButtons);
        made->setFixedWidth(64);
        made->setToolTip(tip);
        made->setAccessibleName(label);
        words->setBuddy(made);
        words->setToolTip(tip);
        row.addWidget(words);
        row.addWidget(made);
        connect(made, &QDoubleSpinBox::valueChanged, this, [this, set = std::move(set)](double value) {
            if (!refreshing_) set(value);
        });
        return made;
    }

    void addTransport(QVBoxLayout& layout) {
        auto* row = new QHBoxLayout;
        row->setSpacing(4);
        row->addWidget(button("timeStart", "jump-start", "To the start",
                              "Go to the start of the range (Home)",
                              [this] { player_.scrub(line().start); }));
        row->addWidget(button("timeBack", "step-back", "Back", "Go back one frame (,)",
                              [this] { player_.scrubFrames(-1); }));
        play_ =
            button("timePlay", "play", "Play",
                   "Play or pause. Hair continues from the last frame that was simulated. Reset it to play "
                   "from the start (Space)",
                   [this] { player_.isPlaying() ? player_.pause() : player_.play(); });
        row->addWidget(play_);
        row->addWidget(button("timeForward", "step", "Forward",
                              "Go forward one frame. From the last frame that was simulated, simulate the "
                              "next (.)",
                              [this] { player_.stepForward(); }));
        row->addWidget(button("timeEnd", "jump-end", "To the end", "Go to the end of the range (End)",
                              [this] { player_.scrub(line().end); }));
        frame_ = spin("timeFrame", "Frame", *row, 1e6, 0, "Frame at the play head", [this](double value) {
            player_.scrub(static_cast<float>(value / static_cast<double>(line().framesPerSecond)));
        });
        auto* key =
            menuButton("timeKey", "Key", "Key head, wind or a setting at the play head, or add a clip there");
        QMenu* const menu = key->menu();
        connect(menu, &QMenu::aboutToShow, this, [this, menu] { fillKeyMenu(*menu); });
        row->addWidget(key);
        remove_ = button("timeDelete", "delete", "Delete keys", "Delete the selected keys (Delete)",
                         [this] { view_->removeSelected(); });
        row->addWidget(remove_);
        curves_ = button("timeCurves", "", "Curves", "Show the values of the selected row as curves", [] {});
        curves_->setCheckable(true);
        connect(curves_, &QToolButton::toggled, this, [this] { refresh(); });
        row->addWidget(curves_);
        state_ = new QLabel;
        state_->setObjectName("timeState");
        state_->setProperty("role", "dim");
        state_->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
        state_->setWordWrap(true);
        row->addWidget(state_, 1);
        layout.addLayout(row);
    }

    void addRange(QVBoxLayout& layout, Actions& actions) {
        auto* row = new QHBoxLayout;
        row->setSpacing(4);
        const auto time = [this](double frame) {
            return static_cast<float>(frame / static_cast<double>(line().framesPerSecond));
        };
        start_ =
            spin("timeStartFrame", "Start", *row, 1e6, 0, "First frame of the range",
                 [this, time](double value) { setRange([&](TimeLine& to) { to.start = time(value); }); });
        end_ = spin("timeEndFrame", "End", *row, 1e6, 0, "Last frame of the range",
                    [this, time](double value) { setRange([&](TimeLine& to) { to.end = time(value); }); });
        rate_ = spin("timeRate", "Rate", *row, 240, 3, "Frames per second. Keys keep their times",
                     [this](double value) {
                         setRange([&](TimeLine& to) { to.framesPerSecond = static_cast<float>(value); });
                     });
        rate_->setMinimum(1);
        preRoll_ =
            spin("timePreRoll", "Pre-roll", *row, 100'000, 0,
                 "Frames on the first pose before the start: they settle the hair", [this](double value) {
                     setRange([&](TimeLine& to) { to.preRoll = static_cast<std::uint32_t>(value); });
                 });
        loop_ = new QCheckBox("Loop");
        loop_->setObjectName("timeLoop");
        loop_->setToolTip("Starts again behind the end, while the hair keeps moving");
        connect(loop_, &QCheckBox::clicked, this,
                [this](bool on) { setRange([&](TimeLine& to) { to.loop = on; }); });
        row->addWidget(loop_);
        row->addWidget(button("timeFit", "frame", "Show all", "Show the whole range and all keys",
                              [this] { view_->fit(); }));
        auto* file = menuButton("timeFile", "File", "Open or save a time line, or clear it");
        for (const char* id : {"timeLine.open", "timeLine.save", "timeLine.saveMotion", "timeLine.clear"})
            file->menu()->addAction(&actions.get(id));
        row->addWidget(file);
        row->addStretch(1);
        layout.addLayout(row);
    }

    QWidget* makeTracks() {
        auto* both = new QWidget;
        auto* layout = new QVBoxLayout(both);
        layout->setContentsMargins(0, 0, 0, 0);
        layout->setSpacing(0);
        layout->addWidget(new TimeRuler(*view_));
        pages_ = new QStackedWidget;
        auto* empty = new QLabel(
            "Nothing is keyed yet. Right-click a setting in Physics and choose Key this, or press Key for "
            "the head, the wind, a setting or a clip of the character.");
        empty->setObjectName("timeNone");
        empty->setWordWrap(true);
        empty->setAlignment(Qt::AlignCenter);
        empty->setProperty("role", "dim");
        auto* rows = new QScrollArea;
        rows->setObjectName("timeRows");
        rows->setWidgetResizable(true);
        rows->setFrameShape(QFrame::NoFrame);
        rows->setFocusPolicy(Qt::NoFocus);
        rows->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
        rows->setWidget(new TrackRows(*view_));
        pages_->addWidget(empty);
        pages_->addWidget(rows);
        pages_->addWidget(new KeyCurves(*view_));
        pages_->setMinimumHeight(TrackRows::kRow_px + 4);
        layout->addWidget(pages_, 1);
        return both;
    }

    const TimeLine& line() const { return keying_.line(); }

    void setRange(const std::function<void(TimeLine&)>& set) {
        TimeLine to = line();
        set(to);
        keying_.change(std::move(to), "Range of the time line");
        refresh();
    }

    /// By their labels.
    void fillSettings(QMenu& menu, std::string_view section) {
        std::map<QString, std::string> byLabel;
        for (const std::string& name : keying_.keyable()) {
            if (name.starts_with(section)) byLabel[labelOf(KeyTrack{KeyTrack::Of::setting, name})] = name;
        }
        for (const auto& [label, name] : byLabel)
            menu.addAction(label, this, [this, name = name] { keying_.keySetting(name); });
    }

    void fillKeyMenu(QMenu& menu) {
        menu.clear();
        menu.addAction("Head, as it is shown", this, [this] { keying_.keyHead(); });
        menu.addAction("Wind, as Physics has it", this, [this] { keying_.keyWind(); });
        fillSettings(*menu.addMenu("Setting of Physics"), "simulation.");
        fillSettings(*menu.addMenu("Setting of Look"), "material.");
        QMenu* poses = menu.addMenu("Amount of a pose");
        fillSettings(*poses, kPosePrefix);
        poses->setEnabled(!poses->isEmpty());
        QMenu* clips = menu.addMenu("Add clip");
        if (player_.actor()) {
            for (const Clip& clip : player_.actor()->clips()) {
                const QString name = QString::fromStdString(clip.name);
                clips->addAction(name, this, [this, name] { keying_.addClip(name); });
            }
        }
        clips->setEnabled(!clips->isEmpty());
    }

    QString stateText() const {
        if (viewport_.pose() != player_.pose()) return "Another panel shows its frame.";
        switch (player_.shown()) {
            case Player::Shown::rest:
                return "At rest.";
            case Player::Shown::simulated:
                return player_.frame()->pose->onDevice
                           ? "Simulated on the GPU, which keeps no frames to go back to."
                           : "Simulated.";
            case Player::Shown::played:
                return "As it played.";
            case Player::Shown::posed:
                return "Posed, not simulated: play first, or select a take.";
        }
        return {};
    }

    void refresh() {
        refreshing_ = true;
        const TimeLine& shown = view_->line();
        const auto frame = [&](float time) {
            return static_cast<double>(view_->frameOf(static_cast<double>(time)));
        };
        frame_->follow(static_cast<double>(player_.lineFrame()));
        start_->follow(frame(shown.start));
        end_->follow(frame(shown.end));
        rate_->follow(static_cast<double>(shown.framesPerSecond));
        preRoll_->follow(shown.preRoll);
        loop_->setChecked(shown.loop);
        const char* const sign = player_.isPlaying() ? "pause" : "play";
        if (playSign_ != sign) play_->setIcon(icon(sign));
        playSign_ = sign;
        remove_->setEnabled(!view_->selection().empty());
        const bool none = shown.isEmpty();
        formArea_->setVisible(!none);
        curves_->setEnabled(!none);
        pages_->setCurrentIndex(none ? 0 : curves_->isChecked() ? 2 : 1);
        showState();
        refreshing_ = false;
    }

    void showState() {
        const QString text = stateText();
        if (state_->text() != text) state_->setText(text);
    }

    Player& player_;
    Keying& keying_;
    const Viewport& viewport_;
    TimeLineView* view_;
    KeyForm* form_;
    QWidget* formArea_ = nullptr;
    QToolButton *play_ = nullptr, *remove_ = nullptr, *curves_ = nullptr;
    NumberSpin *frame_ = nullptr, *start_ = nullptr, *end_ = nullptr, *rate_ = nullptr, *preRoll_ = nullptr;
    QCheckBox* loop_ = nullptr;
    QLabel* state_ = nullptr;
    QStackedWidget* pages_ = nullptr;
    QString playSign_;
    bool refreshing_ = true;  ///< fields follow the time line
};

}  // namespace

PanelInfo timeLinePanel() {
    return {"time_line",
            QString("Time line"),
            "time-line",
            Qt::BottomDockWidgetArea,
            90,
            false,
            [](const PanelParts& parts) -> QWidget* { return new TimeLinePanel(parts); }};
}

}  // namespace hairloom::editor
