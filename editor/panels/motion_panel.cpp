// SPDX-License-Identifier: GPL-3.0-or-later
// How the head moves while the simulation plays, and how the hair is doing.
#include <QComboBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QVBoxLayout>

#include "editor/panels/list.h"
#include "editor/panels/panel.h"
#include "editor/session.h"
#include "editor/shell/icons.h"

namespace hairloom::editor {
namespace {

class MotionPanel : public QWidget {
  public:
    explicit MotionPanel(Session& session) : session_(session), motion_(new QComboBox), state_(new QLabel) {
        auto* layout = new QVBoxLayout(this);
        layout->setContentsMargins(0, 0, 0, 0);
        layout->setSpacing(8);
        motion_->setObjectName("motion");
        motion_->setToolTip(tr("How the head moves: at rest, a nod, a spin, or a clip of the character"));
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
        auto* play = add("motionPlay", "play", tr("Play"), tr("Lets the hair move, or stops it (Space)"));
        auto* step = add("motionStep", "step", tr("Step"), tr("One frame of 1/60 s"));
        auto* reset = add("motionReset", "reset", tr("Reset"), tr("Hair back to its authored shape"));
        layout->addLayout(row);
        state_->setObjectName("motionState");
        state_->setTextFormat(Qt::RichText);
        layout->addWidget(state_);
        connect(play, &QPushButton::clicked, this,
                [this] { session_.player.isPlaying() ? session_.player.pause() : session_.player.play(); });
        connect(step, &QPushButton::clicked, &session_.player, &Player::step);
        connect(reset, &QPushButton::clicked, &session_.player, &Player::reset);
        connect(&session_.player, &Player::stateChanged, this, [this, play] {
            play->setIcon(icon(session_.player.isPlaying() ? "pause" : "play"));
            play->setText(session_.player.isPlaying() ? tr("Pause") : tr("Play"));
        });
        connect(motion_, &QComboBox::activated, this, [this](int index) {
            if (auto set = session_.player.setMotion(motion_->itemData(index).toString()); !set) {
                session_.messages.warn(QString::fromStdString(set.error().message()));
            }
        });
        connect(&session_.player, &Player::motionsChanged, this, &MotionPanel::fill);
        connect(&session_.player, &Player::frameReady, this, &MotionPanel::showState);
        fill();
        showState();
    }

  private:
    void fill() {
        motion_->clear();
        for (const QString& name : session_.player.motions()) {
            QString label = name.startsWith("clip:") ? tr("Clip: %1").arg(name.mid(5)) : name;
            label[0] = label[0].toUpper();
            motion_->addItem(label, name);
        }
        motion_->setCurrentIndex(std::max(0, motion_->findData(session_.player.motion())));
    }

    void showState() {
        const auto& frame = session_.player.frame();
        if (!frame) {
            state_->setText(tr("At rest."));
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
                        row(tr("Time"), tr("%1 s").arg(frame->time, 0, 'f', 2)) +
                        row(tr("Frame"), tr("%1 ms").arg(frame->milliseconds, 0, 'f', 2)) +
                        row(tr("Maximum stretch"), tr("%1 %").arg(stats.maxStretch * 100, 0, 'f', 2)) +
                        row(tr("Deepest in a sphere"), tr("%1 mm").arg(stats.maxPenetrationMm, 0, 'f', 2)) +
                        row(tr("Reset to rest"), tr("%1 strands").arg(stats.restoredStrands)) + "</table>");
    }

    Session& session_;
    QComboBox* motion_;
    QLabel* state_;
};

}  // namespace

QWidget* makeMotionPanel(Session& session) {
    return scrolled(column({new MotionPanel(session)}));
}

}  // namespace hairloom::editor
