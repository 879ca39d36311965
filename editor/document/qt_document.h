// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The groom being edited, for widgets: the document of core/editing with Qt's signals. Everything that
// changes it is a command; everyone else listens.

#include <QObject>
#include <QString>
#include <functional>
#include <memory>
#include <span>

#include "core/base/result.h"
#include "core/editing/model.h"

namespace hairloom::editing {
class Command;
class Document;
class Subscription;
struct Stroke;
}  // namespace hairloom::editing

namespace hairloom::editor {

class QtDocument : public QObject {
    Q_OBJECT

  public:
    explicit QtDocument(QObject* parent = nullptr);
    ~QtDocument() override;

    const Groom& groom() const;
    /// For tools: strokes and commands. Valid until another groom is opened.
    editing::Document& editing() { return *editing_; }
    const editing::Document& editing() const { return *editing_; }
    /// Neither a head nor hair.
    bool isEmpty() const { return !groom().scalp && groom().strandCount() == 0; }

    /// The project file, absolute; empty before the first save.
    const QString& path() const { return path_; }
    /// File name, or what the document was made from.
    QString title() const;
    bool isModified() const;

    /// Takes another groom and forgets the history. `path` is its project file, if it has one; `name` is what
    /// title() says otherwise.
    void open(Groom groom, const QString& path, const QString& name);
    /// As open(), for a groom that is not what the file at `path` holds.
    void restore(Groom groom, const QString& path, const QString& name);

    /// Carries a command out; null does nothing.
    void perform(std::unique_ptr<editing::Command> command);
    /// Carries out what `make` gives. Steps that follow each other with the same key become one: a slider
    /// being dragged.
    using Make = std::function<std::unique_ptr<editing::Command>(const editing::Model&)>;
    void performMerged(quint64 key, const Make& make);
    /// One that was never used.
    static quint64 nextMergeKey();
    /// Errors: as of the document.
    Status beginStroke(editing::Stroke header);

    /// The project as it was at that state of editing() is in the file at `path`, which is the document's
    /// now.
    void noteSaved(const QString& path, quint64 state);

    /// While changed() is said: the strands that changed, where nothing but the places of their points did.
    std::span<const std::uint32_t> movedStrands() const { return moved_; }

    // The history: steps done and, after them, steps undone.
    int stepCount() const;
    int doneSteps() const;
    QString stepName(int step) const;
    void undo();
    void redo();
    /// Undoes or redoes until so many steps are done.
    void goToStep(int done);
    /// Memory that the history holds beyond the groom itself, and how much it may hold; bytes.
    std::size_t historyBytes() const;
    std::size_t historyLimit() const;
    /// Of this document and those opened later. The oldest steps go where there are too many.
    void setHistoryLimit(std::size_t bytes);

  Q_SIGNALS:
    /// Parts of the groom; never none, and never the history.
    void changed(hairloom::editing::Part parts);
    void historyChanged();
    /// Another groom has been opened; changed() follows.
    void replaced();
    /// noteSaved() was called; titleChanged() follows.
    void saved();
    /// Who holds a copy of the groom lets go of it, or the stroke pays for it.
    void strokeBegins();
    /// Path, name or modification.
    void titleChanged();

  private:
    void watch();
    void notify(const editing::Change& change);

    std::unique_ptr<editing::Document> editing_;
    std::unique_ptr<editing::Subscription> subscription_;
    QString path_;
    QString name_;
    bool restored_ = false;
    std::span<const std::uint32_t> moved_;
};

}  // namespace hairloom::editor
