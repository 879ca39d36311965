// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// One change of the groom. Holds the groom before and after; arrays that the change did not touch are shared
// with the document, so it costs what it touched.

#include <QUndoCommand>

#include "editor/document/document.h"

namespace hairloom::editor {

class GroomCommand : public QUndoCommand {
  public:
    GroomCommand(Document& document, const QString& text, Changes changes, Groom after, quint64 mergeKey);

    void undo() override;
    void redo() override;
    int id() const override;
    bool mergeWith(const QUndoCommand* next) override;

    /// Of arrays that before and after do not share.
    std::size_t bytes() const;

  private:
    Document& document_;
    Changes changes_;
    Groom before_;
    Groom after_;
    quint64 mergeKey_;
};

}  // namespace hairloom::editor
