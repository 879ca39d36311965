// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// One line for people, shown in the status bar: what happened, what went wrong, what to do.

#include <QObject>
#include <QString>

namespace hairloom::editor {

class Messages : public QObject {
    Q_OBJECT

  public:
    void say(const QString& text) { Q_EMIT said(text, false); }
    void warn(const QString& text) { Q_EMIT said(text, true); }

  Q_SIGNALS:
    void said(const QString& text, bool isWarning);
};

}  // namespace hairloom::editor
