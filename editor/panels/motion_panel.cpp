// SPDX-License-Identifier: GPL-3.0-or-later
// How the head moves while the simulation plays, and how the hair is doing.
#include <QComboBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QVBoxLayout>

#include "editor/document/words.h"
#include "editor/fields/blocks.h"
#include "editor/fields/length_text.h"
#include "editor/panels/panel.h"
#include "editor/style/icons.h"

namespace hairloom::editor {
namespace {

class MotionPanel : public QWidget {
  public:
    MotionPanel(const Preferences& preferences, Messages& messages, Player& player)
        : preferences_(preferences),
          messages_(messages),
          player_(player),
          motion_(new QComboBox),
          state_(new QLabel) {
        auto* layout = new QVBoxLayout(this);
        layout->setContentsMargins(0, 0, 0, 0);
        layout->setSpacing(8);
        motion_->setObjectName("motion");
        motion_->setToolTip(
            "Motion of the head: at rest, a nod, a spin, an animation clip of the character, or the "
            "project's time line");
        layout->addWidget(motion_);
        auto* row = new QHBoxLayout;
        const auto add = [&](const char* name, const char* iconName, const QString& text,
                             const QString& tip) {
            auto* made = new QPushButton(icon(iconName), text);
            made->setObjectName(name);
            made->setToolTip(tip);
            row->addWidget(made);
            return made;
        };
        auto* play = add("motionPlay", "play", "Play", "Play or pause the simulation (Space)");
        auto* step = add("motionStep", "step", "Step", "Advance by one frame: 1/60 s, or of the time line");
        auto* reset = add("motionReset", "reset", "Reset", "Reset the hair to its authored shape");
        layout->addLayout(row);
        state_->setObjectName("motionState");
        state_->setTextFormat(Qt::RichText);
        layout->addWidget(state_);
        connect(play, &QPushButton::clicked, this,
                [this] { player_.isPlaying() ? player_.pause() : player_.play(); });
        connect(step, &QPushButton::clicked, &player_, &Player::step);
        connect(reset, &QPushButton::clicked, &player_, &Player::reset);
        connect(&player_, &Player::stateChanged, this, [this, play] {
            play->setIcon(icon(player_.isPlaying() ? "pause" : "play"));
            play->setText(player_.isPlaying() ? QString("Pause") : QString("Play"));
        });
        connect(motion_, &QComboBox::activated, this, [this](int index) {
            if (auto set = player_.setMotion(motion_->itemData(index).toString()); !set) {
                messages_.warn(errorText(set.error()));
            }
        });
        connect(&player_, &Player::motionsChanged, this, &MotionPanel::fill);
        connect(&player_, &Player::frameReady, this, paced(*this, [this] { showState(); }));
        fill();
        showState();
    }

  private:
    void fill() {
        motion_->clear();
        for (const QString& name : player_.motions()) {
            QString label = name.startsWith("clip:") ? QString("Clip: %1").arg(name.mid(5)) : name;
            label[0] = label[0].toUpper();
            if (name == Player::kTimeLine) label = "Time line";
            motion_->addItem(label, name);
        }
        motion_->setCurrentIndex(std::max(0, motion_->findData(player_.motion())));
    }

    void showState() {
        const auto& frame = player_.frame();
        if (!frame) {
            state_->setText("At rest.");
            return;
        }
        const auto row = [](const QString& what, const QString& value) {
            return QStringLiteral(
                       "<tr><td style='padding:1px 16px 1px 0px'>%1</td><td align='right' style='padding:1px "
                       "0px'>%2</td></tr>")
                .arg(what, value);
        };
        const SimulationStats& stats = frame->stats;
        state_->setText("<table width='100%' cellspacing='0' cellpadding='0'>" +
                        row("Time", QString("%1 s").arg(frame->time, 0, 'f', 2)) +
                        row("Frame", QString("%1 ms").arg(frame->milliseconds, 0, 'f', 2)) +
                        row("Maximum stretch", QString("%1 %").arg(stats.maxStretch * 100, 0, 'f', 2)) +
                        row("Deepest penetration", lengthText(1e-3 * stats.maxPenetrationMm, preferences_)) +
                        row("Strands reset", QString("%1 strands").arg(stats.restoredStrands)) + "</table>");
    }

    const Preferences& preferences_;
    Messages& messages_;
    Player& player_;
    QComboBox* motion_;
    QLabel* state_;
};

}  // namespace

PanelInfo motionPanel() {
    return {"motion",
            QString("Motion"),
            "play",
            Qt::RightDockWidgetArea,
            70,
            true,
            [](const PanelParts& parts) -> QWidget* {
                return scrolled(column({new MotionPanel(parts.preferences, parts.messages, parts.player)}));
            }};
}

}  // namespace hairloom::editor
