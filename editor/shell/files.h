// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Opening files into the document: projects, heads, hair, samples. The reading runs as a task.

#include <QString>
#include <filesystem>
#include <optional>

#include "core/animation/actor.h"
#include "core/documents/head_import.h"
#include "core/documents/recovery.h"
#include "core/groom/groom_diff.h"
#include "editor/document/messages.h"
#include "editor/document/preferences.h"
#include "editor/document/qt_document.h"
#include "editor/document/tasks.h"
#include "editor/simulation/player.h"
#include "importers/strands.h"

namespace hairloom::editor {

enum class FileKind {
    Project,
    Head,     ///< a mesh, with its skeleton and clips
    Strands,  ///< hair of another program
};
/// From the beginning of the file, and the name where that does not tell. OBJ may be either: it is a head
/// where it has faces that are no ribbons of hair, for which all of it is read.
FileKind kindOf(const QString& path);

/// How a project is opened that somebody else has to do with, too.
enum class Opening {
    AsItself,
    AsCopy,  ///< what it holds, with no file of its own
    Not,
};

/// For file dialogs: all that opens, hair of other programs alone, with projects, and heads alone.
QString openFilter();
QString strandFilter();
QString blendFilter();
QString headFilter();

class DocumentFiles {
  public:
    DocumentFiles(QtDocument& document, Player& player, Preferences& preferences, Tasks& tasks,
                  Messages& messages)
        : document_(document),
          player_(player),
          preferences_(preferences),
          tasks_(tasks),
          messages_(messages) {}

    /// `done` with what the file is: at once where its beginning tells, or else when it was read.
    void tellKind(const QString& path, std::function<void(FileKind)> done);
    /// Project or head, opened as the document; hair as it is, without a head. `done` is called when it is
    /// there.
    void open(const QString& path, std::function<void()> done = {});
    /// The project of the document as it is on the disk.
    void reload();
    /// Asked before a project is opened.
    void onProject(std::function<Opening(const QString& path)> call) { mayOpen_ = std::move(call); }
    /// Asked where the document has changed while another was read: whether it may go.
    void onChangedMeanwhile(std::function<bool()> call) { mayReplace_ = std::move(call); }
    /// A head taken out of its file by these options.
    void openHead(const QString& path, const HeadImportOptions& options);
    /// Called when a head was opened whose size, axis or groups look wrong.
    void onUnclearHead(std::function<void(const QString& path)> call) { unclearHead_ = std::move(call); }
    /// Called when a project was opened whose head's file is not there.
    void onMissingHead(std::function<void(const QString& file)> call) { missingHead_ = std::move(call); }
    /// The file of the document's head, which lies elsewhere than the project says: skeleton and clips come
    /// from it, and the project remembers it once it is saved.
    void findHead(const QString& path);
    /// A sample of samples/hairstyles, or the bare bust where the name is empty.
    void openSample(const QString& name);
    /// Strands with these options, bound to the head of the document if it has one, replacing its strands.
    void importStrands(const QString& path, const StrandImportOptions& options);
    /// The hair of the document onto the head of the file.
    void transferTo(const QString& path);
    /// The hair of the document halfway to the shape of that of the file.
    void blendWith(const QString& path);
    /// What changed from the file's hair to that of the document. `done` is called with it.
    void compareWith(const QString& path, std::function<void(const GroomComparison&, ComparedParts)> done);
    /// What a crash left.
    void openRecovered(const RecoveryCopy& copy);
    /// The document was saved: the copy that it came from has served.
    void discardRecovered();
    /// Another document is there.
    void forgetRecovered() { recovered_.reset(); }

  private:
    struct Opened;
    static std::shared_ptr<const Actor> actorOf(const Groom& groom);
    static Result<Opened> readHead(const std::string& path, const HeadImportOptions& options);
    static Result<Opened> openProject(const std::string& path);
    static Result<Opened> openedStrands(Result<ImportedStrands> imported);
    void openFile(const QString& path, Opening opening, std::function<void()> done);
    /// Whether what was read may take the document's place, which was in that state when reading began.
    bool mayShow(quint64 before, const QString& name);
    void show(Opened opened, const QString& path, const QString& name);

    QtDocument& document_;
    Player& player_;
    Preferences& preferences_;
    Tasks& tasks_;
    Messages& messages_;
    std::function<void(const QString& path)> unclearHead_;
    std::function<void(const QString& file)> missingHead_;
    std::function<Opening(const QString& path)> mayOpen_;
    std::function<bool()> mayReplace_;
    std::optional<RecoveryCopy> recovered_;  ///< that the document came from
};

std::filesystem::path samplesFolder();

}  // namespace hairloom::editor
