// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A copy of what is unsaved, written every few minutes beside nothing of the user's, and offered again when
// the program did not end as it should.

#include <QDateTime>
#include <QLockFile>
#include <QTimer>
#include <memory>
#include <optional>
#include <thread>

#include "editor/document/preferences.h"
#include "editor/document/qt_document.h"

namespace hairloom::editor {

/// What a program that ended badly left behind.
struct Recovery {
    QString file;          ///< the copy
    QString documentPath;  ///< the project it is a copy of; may be empty
    QString name;
    QDateTime when;
};

class Autosave : public QObject {
    Q_OBJECT

  public:
    Autosave(QtDocument& document, const Preferences& preferences, QObject* parent = nullptr);
    /// A proper end: takes the copy away.
    ~Autosave() override;

    /// Copies whose program no longer runs, the newest first.
    static QList<Recovery> recoveries();
    static void discard(const Recovery& recovery);

    /// Writes now, on a thread of its own, if there is something unsaved that was not written yet.
    void saveNow();
    /// Waits for the writing that is under way.
    void finish();
    const QString& file() const { return file_; }

  Q_SIGNALS:
    void failed(const QString& message);

  private:
    void restart();

    QtDocument& document_;
    const Preferences& preferences_;
    QString file_;
    std::unique_ptr<QLockFile> lock_;
    QTimer timer_;
    std::thread writer_;
    bool dirty_ = false;
};

}  // namespace hairloom::editor
