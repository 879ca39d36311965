// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/document/document.h"

#include <QFileInfo>

#include "core/groom/project_file.h"
#include "editor/document/groom_command.h"

namespace hairloom::editor {

Document::Document(QObject* parent) : QObject(parent) {
    connect(&undo_, &QUndoStack::cleanChanged, this, &Document::titleChanged);
    connect(&undo_, &QUndoStack::indexChanged, this, &Document::historyChanged);
}

QString Document::title() const {
    if (!path_.isEmpty()) return QFileInfo(path_).fileName();
    return name_.isEmpty() ? tr("Untitled") : name_;
}

void Document::open(Groom groom, const QString& path, const QString& name) {
    undo_.clear();
    restored_ = false;
    path_ = path;
    name_ = name;
    groom_ = std::move(groom);
    Q_EMIT replaced();
    Q_EMIT changed(kEverything);
    Q_EMIT titleChanged();
}

void Document::restore(Groom groom, const QString& path, const QString& name) {
    open(std::move(groom), path, name);
    restored_ = true;
    Q_EMIT titleChanged();
}

void Document::change(const QString& text, Changes changes, Groom after, quint64 mergeKey) {
    undo_.push(new GroomCommand(*this, text, changes, std::move(after), mergeKey));
}

Status Document::save(const QString& path) {
    if (auto status = saveProject(groom_, path.toStdString()); !status) return status;
    path_ = path;
    restored_ = false;
    undo_.setClean();
    Q_EMIT titleChanged();
    return {};
}

std::size_t Document::historyBytes() const {
    std::size_t bytes = 0;
    for (int i = 0; i < undo_.count(); ++i) {
        if (const auto* command = dynamic_cast<const GroomCommand*>(undo_.command(i))) bytes += command->bytes();
    }
    return bytes;
}

void Document::set(const Groom& groom, Changes changes) {
    groom_ = groom;
    Q_EMIT changed(changes);
}

}  // namespace hairloom::editor
