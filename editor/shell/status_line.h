// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The line at the bottom: what happened, work under way with its cancel button, strands, points, frame time,
// device.

#include <QLabel>
#include <QProgressBar>
#include <QStatusBar>
#include <QTimer>
#include <QToolButton>
#include <optional>
#include <utility>

#include "editor/document/messages.h"
#include "editor/document/preferences.h"
#include "editor/document/qt_document.h"
#include "editor/document/tasks.h"
#include "editor/simulation/player.h"
#include "editor/viewport/viewport.h"

namespace hairloom::editor {

class StatusLine : public QStatusBar {
    Q_OBJECT

  public:
    StatusLine(QtDocument& document, const Preferences& preferences, Tasks& tasks, Messages& messages,
               Player& player, Viewport& viewport, QWidget* parent = nullptr);
    QString message() const { return message_->text(); }
    /// A warning that stands until it is taken back by an empty one.
    void setStanding(const QString& warning);
    QString standing() const { return standing_->text(); }
    /// What the active tool says to do; stands when nothing else is said.
    void setHint(const QString& hint);

  private:
    void say(const QString& text, bool isWarning);
    void showCounts(editing::Part changed);
    void showHead();
    void showEngine();
    void showWork();

    QtDocument& document_;
    const Preferences& preferences_;
    Tasks& tasks_;
    Messages& messages_;
    Player& player_;
    Viewport& viewport_;
    QLabel* standing_;
    QLabel* message_;
    QLabel* counts_;
    QLabel* head_;
    QLabel* frameTime_;
    QLabel* engine_;
    QLabel* device_;
    QProgressBar* progress_;
    QToolButton* cancel_;
    QTimer poll_;
    QTimer fade_;
    QString hint_;
    bool warning_ = false;
};

}  // namespace hairloom::editor
