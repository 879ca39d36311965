// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The groom being edited. Everything that changes it is a command on the undo stack; everyone else listens.

#include <QObject>
#include <QString>
#include <QUndoStack>

#include "core/groom/groom.h"

namespace hairloom::editor {

/// Parts of a groom that a change touches.
enum class Change : unsigned {
    Strands = 1,
    Scalp = 2,  ///< the mesh or what of it is selected
    Spheres = 4,
    Look = 8,
    Simulation = 16,
    FollowHairs = 32,
};
Q_DECLARE_FLAGS(Changes, Change)
Q_DECLARE_OPERATORS_FOR_FLAGS(Changes)
inline constexpr Changes kEverything{0x3f};

class Document : public QObject {
    Q_OBJECT

  public:
    explicit Document(QObject* parent = nullptr);

    const Groom& groom() const { return groom_; }
    /// Neither a head nor hair.
    bool isEmpty() const { return !groom_.scalp && groom_.strandCount() == 0; }

    /// The project file; empty before the first save.
    const QString& path() const { return path_; }
    /// File name, or what the document was made from.
    QString title() const;
    bool isModified() const { return restored_ || !undo_.isClean(); }

    /// Takes another groom and forgets the history. `path` is its project file, if it has one; `name` is what
    /// title() says otherwise.
    void open(Groom groom, const QString& path, const QString& name);
    /// As open(), for a groom that is not what the file at `path` holds.
    void restore(Groom groom, const QString& path, const QString& name);

    /// Makes `after` the groom, undoably. Changes that follow each other with the same `mergeKey` other than
    /// 0 become one: a slider being dragged.
    void change(const QString& text, Changes changes, Groom after, quint64 mergeKey = 0);

    /// Writes the project and takes `path` as its file.
    Status save(const QString& path);

    // The history: steps done and, after them, steps undone.
    int stepCount() const { return undo_.count(); }
    int doneSteps() const { return undo_.index(); }
    QString stepName(int step) const { return undo_.text(step); }
    void undo() { undo_.undo(); }
    void redo() { undo_.redo(); }
    /// Undoes or redoes until so many steps are done.
    void goToStep(int done) { undo_.setIndex(done); }
    /// Memory that the history holds beyond the groom itself, bytes.
    std::size_t historyBytes() const;

  Q_SIGNALS:
    void historyChanged();
    void changed(hairloom::editor::Changes changes);
    /// Another groom has been opened; changed() follows.
    void replaced();
    /// Path, name or modification.
    void titleChanged();

  private:
    friend class GroomCommand;
    void set(const Groom& groom, Changes changes);

    Groom groom_;
    QUndoStack undo_;
    QString path_;
    QString name_;
    bool restored_ = false;
};

}  // namespace hairloom::editor
