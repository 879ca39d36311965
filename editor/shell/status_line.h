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

#include "editor/session.h"

namespace hairloom::editor {

class StatusLine : public QStatusBar {
    Q_OBJECT

  public:
    explicit StatusLine(Session& session, QWidget* parent = nullptr);
    QString message() const { return message_->text(); }
    /// What the active tool says to do; stands when nothing else is said.
    void setHint(const QString& hint);

  private:
    void say(const QString& text, bool isWarning);
    void showCounts();
    void showWork();

    Session& session_;
    QLabel* message_;
    QLabel* counts_;
    QLabel* frameTime_;
    QLabel* device_;
    QProgressBar* progress_;
    QToolButton* cancel_;
    QTimer poll_;
    QTimer fade_;
    QString hint_;
    std::optional<std::pair<std::size_t, std::size_t>> counted_;  ///< strands and points as shown
    bool warning_ = false;
};

}  // namespace hairloom::editor
