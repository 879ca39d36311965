// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A copy of what is unsaved, written within a minute beside nothing of the user's, and offered again when the
// program did not end as it should.

#include <QTimer>
#include <filesystem>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "core/documents/recovery.h"
#include "editor/document/preferences.h"
#include "editor/document/qt_document.h"

namespace hairloom::editor {

class Autosave : public QObject {
    Q_OBJECT

  public:
    Autosave(QtDocument& document, const Preferences& preferences, QObject* parent = nullptr);
    /// A proper end: takes the copy away, unless keep() was called.
    ~Autosave() override;

    /// Writes on a thread of its own, if there is something unsaved that was not written yet.
    void saveNow();
    /// Waits for the writing that is under way, and for what it says.
    void finish();
    /// The program ends and nobody has been asked: writes what is unsaved, and leaves it.
    void keep();
    /// The same where the thread of the interface does not come to it: what was unsaved when it last stood
    /// still. On any thread.
    void keepFromElsewhere();
    /// After keep(), where no destructor follows: nothing but the copy is left.
    void leave();
    /// The question was answered: a proper end takes the copy away again.
    void dismiss() { keepsCopy_ = false; }
    /// The project is being saved: no copy is begun. What is locked by writing() no copy is written in.
    void pause(bool paused);
    std::mutex& writing() { return writing_; }

    /// The copy, which need not exist; empty where there is no place for one.
    QString file() const;
    /// Other windows that have the document's project open.
    std::vector<OpenDocument> otherWindows() const;
    std::vector<OpenDocument> otherWindowsWith(const QString& project) const;

  Q_SIGNALS:
    /// No copy could be written; it is tried again.
    void failed(const QString& message);
    /// The copy has what is unsaved, or nothing is.
    void upToDate();

  private:
    void takePlace();
    OpenDocument description() const;
    void describe();
    void changed();
    void schedule();
    void written(quint64 generation, const Status& status);
    bool hasUnsaved() const;
    void noteUnsaved();

    QtDocument& document_;
    const Preferences& preferences_;
    std::optional<RecoveryPlace> place_;
    QTimer timer_{this};
    std::thread writer_;
    std::mutex writing_;
    /// What is unsaved, while no stroke goes on, which would pay for a copy that is held, and the copy's
    /// name.
    std::optional<std::pair<Groom, std::filesystem::path>> unsaved_;
    std::mutex unsavedMutex_;
    bool isWriting_ = false, isPaused_ = false;
    bool dirty_ = false;      ///< changed since the copy that was written or is being written
    bool hasFailed_ = false;  ///< the last one did
    bool keepsCopy_ = false;
    quint64 generation_ = 0;  ///< a copy of an earlier one is not wanted any more
};

}  // namespace hairloom::editor
