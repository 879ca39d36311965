// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The system's word that the program is to end, where the window can act on it.

#include <QObject>

namespace hairloom::editor {

/// SIGTERM, SIGINT and SIGHUP; Windows says so by QGuiApplication::commitDataRequest() alone. The second of a
/// kind ends the process at once. One lives at a time.
class EndSignals : public QObject {
    Q_OBJECT

  public:
    explicit EndSignals(QObject* parent = nullptr);
    /// Leaves the signals to whom they were before.
    ~EndSignals() override;

    /// The number of the one that came, 0 for none.
    int last() const { return last_; }
    /// Ends the process as the signal that came would have; returns where none came.
    void endProcess() const;

  Q_SIGNALS:
    void received(int signal);

  private:
    int last_ = 0;
};

}  // namespace hairloom::editor
