// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/document/qt_document.h"

#include <QFileInfo>
#include <utility>

#include "core/editing/document.h"

namespace hairloom::editor {

QtDocument::QtDocument(QObject* parent) : QObject(parent), editing_(std::make_unique<editing::Document>()) {
    watch();
}

QtDocument::~QtDocument() = default;

const Groom& QtDocument::groom() const {
    return editing_->groom();
}
bool QtDocument::isModified() const {
    return restored_ || editing_->isModified();
}
int QtDocument::stepCount() const {
    return static_cast<int>(editing_->history().size());
}
int QtDocument::doneSteps() const {
    return static_cast<int>(editing_->history().doneCount());
}
std::size_t QtDocument::historyBytes() const {
    return editing_->history().bytes();
}
std::size_t QtDocument::historyLimit() const {
    return editing_->history().limit();
}

void QtDocument::setHistoryLimit(std::size_t bytes) {
    if (bytes == historyLimit()) return;
    editing_->setHistoryLimit(bytes);
    Q_EMIT historyChanged();
}

void QtDocument::watch() {
    subscription_ = std::make_unique<editing::Subscription>(
        editing_->observe([this](const editing::Change& change) { notify(change); }));
}

void QtDocument::notify(const editing::Change& change) {
    using editing::Part;
    const Part parts = without(change.parts, Part::History);
    if (parts == Part::Points) moved_ = change.strands;
    if (parts != Part::None) Q_EMIT changed(parts);
    moved_ = {};
    if (!editing::contains(change.parts, Part::History)) return;
    Q_EMIT historyChanged();
    Q_EMIT titleChanged();
}

QString QtDocument::title() const {
    if (!path_.isEmpty()) return QFileInfo(path_).fileName();
    return name_.isEmpty() ? QString("Untitled") : name_;
}

void QtDocument::open(Groom groom, const QString& path, const QString& name) {
    auto opened = std::make_unique<editing::Document>(std::move(groom));
    // What a head costs to prepare is kept while the head stays.
    const std::shared_ptr<const SkinField> held = editing_->heldSkin();
    if (held && &held->skin().mesh() == opened->groom().scalp.get()) opened->skin();
    opened->setHistoryLimit(historyLimit());
    subscription_.reset();
    editing_ = std::move(opened);
    watch();
    restored_ = false;
    path_ = path.isEmpty() ? path : QFileInfo(path).absoluteFilePath();
    name_ = name;
    Q_EMIT replaced();
    Q_EMIT changed(editing::Part::Everything);
    Q_EMIT historyChanged();
    Q_EMIT titleChanged();
}

void QtDocument::restore(Groom groom, const QString& path, const QString& name) {
    open(std::move(groom), path, name);
    restored_ = true;
    Q_EMIT titleChanged();
}

void QtDocument::perform(std::unique_ptr<editing::Command> command) {
    if (editing_->stroke()) editing_->cancelStroke();
    editing_->perform(std::move(command));
}

void QtDocument::performMerged(quint64 key, const Make& make) {
    if (editing_->stroke()) editing_->cancelStroke();
    editing_->performMerged(key, make);
}

Status QtDocument::beginStroke(editing::Stroke header) {
    Q_EMIT strokeBegins();
    return editing_->beginStroke(std::move(header));
}

quint64 QtDocument::nextMergeKey() {
    static quint64 last = 0;
    return ++last;
}

void QtDocument::noteSaved(const QString& path, quint64 state) {
    editing_->noteSaved(state);
    path_ = QFileInfo(path).absoluteFilePath();
    restored_ = false;
    Q_EMIT saved();
    Q_EMIT titleChanged();
}

QString QtDocument::stepName(int step) const {
    return QString::fromStdString(editing_->history().name(static_cast<std::size_t>(step)));
}

void QtDocument::undo() {
    editing_->undo();
}

void QtDocument::redo() {
    editing_->redo();
}

void QtDocument::goToStep(int done) {
    while (doneSteps() > done && editing_->canUndo()) undo();
    while (doneSteps() < done && editing_->canRedo()) redo();
}

}  // namespace hairloom::editor
