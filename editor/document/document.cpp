// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/document/document.h"

#include <QFileInfo>
#include <array>
#include <utility>

#include "core/editing/document.h"
#include "editor/document/groom_command.h"

namespace hairloom::editor {
namespace {

using editing::Part;

constexpr std::array<std::pair<Part, Change>, 14> kParts{{
    {Part::Points, Change::Strands},
    {Part::Strands, Change::Strands},
    {Part::StrandFlags, Change::Strands},
    {Part::Layers, Change::Strands},
    {Part::Triangulation, Change::Strands},
    {Part::Head, Change::Scalp},
    {Part::ScalpFaces, Change::Scalp},
    {Part::Density, Change::Scalp},
    {Part::Spheres, Change::Spheres},
    {Part::Material, Change::Look},
    {Part::Dye, Change::Look},
    {Part::Physics, Change::Simulation},
    {Part::Interpolation, Change::FollowHairs},
    {Part::Placement, Change::Placement},
}};

Changes changesOf(Part parts) {
    Changes changes;
    for (const auto& [part, change] : kParts) {
        if (editing::contains(parts, part)) changes |= change;
    }
    return changes;
}

Part partsOf(Changes changes) {
    Part parts = Part::None;
    for (const auto& [part, change] : kParts) {
        if (changes & change) parts = parts | part;
    }
    return parts;
}

}  // namespace

Document::Document(QObject* parent) : QObject(parent), editing_(std::make_unique<editing::Document>()) {
    watch();
}

Document::~Document() = default;

const Groom& Document::groom() const {
    return editing_->groom();
}
bool Document::isModified() const {
    return restored_ || editing_->isModified();
}
int Document::stepCount() const {
    return static_cast<int>(editing_->history().size());
}
int Document::doneSteps() const {
    return static_cast<int>(editing_->history().doneCount());
}
std::size_t Document::historyBytes() const {
    return editing_->history().bytes();
}
std::size_t Document::historyLimit() const {
    return editing_->history().limit();
}

void Document::watch() {
    subscription_ = std::make_unique<editing::Subscription>(
        editing_->observe([this](const editing::Change& change) { tell(change); }));
}

void Document::tell(const editing::Change& change) {
    if (silent_) return;
    const bool onlyMoved = change.parts == Part::Points || change.parts == (Part::Points | Part::History);
    if (onlyMoved) moved_ = change.strands;
    if (const Changes changes = changesOf(change.parts)) Q_EMIT changed(changes);
    moved_ = {};
    if (!editing::contains(change.parts, Part::History)) return;
    Q_EMIT historyChanged();
    Q_EMIT titleChanged();
}

QString Document::title() const {
    if (!path_.isEmpty()) return QFileInfo(path_).fileName();
    return name_.isEmpty() ? tr("Untitled") : name_;
}

void Document::open(Groom groom, const QString& path, const QString& name) {
    auto opened = std::make_unique<editing::Document>(std::move(groom));
    // What a head costs to prepare is kept while the head stays.
    if (opened->groom().scalp && opened->groom().scalp == editing_->headData().head) {
        opened->setHeadData(editing_->headData());
    }
    subscription_.reset();
    editing_ = std::move(opened);
    watch();
    restored_ = false;
    lastMerge_ = 0;
    path_ = path;
    name_ = name;
    Q_EMIT replaced();
    Q_EMIT changed(kEverything);
    Q_EMIT historyChanged();
    Q_EMIT titleChanged();
}

void Document::restore(Groom groom, const QString& path, const QString& name) {
    open(std::move(groom), path, name);
    restored_ = true;
    Q_EMIT titleChanged();
}

void Document::perform(std::unique_ptr<editing::Command> command) {
    if (editing_->stroke()) editing_->cancelStroke();
    lastMerge_ = 0;
    editing_->perform(std::move(command));
}

void Document::change(const QString& text, Changes changes, Groom after, quint64 mergeKey) {
    if (editing_->stroke()) editing_->cancelStroke();
    if (mergeKey != 0 && mergeKey == lastMerge_ && doneSteps() == stepCount()) {
        // The step takes the place of the one before it.
        silent_ = true;
        editing_->undo();
        silent_ = false;
    }
    editing_->perform(std::make_unique<GroomCommand>(text.toStdString(), partsOf(changes), std::move(after)));
    lastMerge_ = mergeKey;
}

quint64 Document::nextMergeKey() {
    static quint64 last = 0;
    return ++last;
}

Status Document::save(const QString& path) {
    if (auto status = editing_->save(path.toStdString()); !status) return status;
    path_ = path;
    restored_ = false;
    Q_EMIT titleChanged();
    return {};
}

QString Document::stepName(int step) const {
    return QString::fromStdString(editing_->history().name(static_cast<std::size_t>(step)));
}

void Document::undo() {
    lastMerge_ = 0;
    editing_->undo();
}

void Document::redo() {
    lastMerge_ = 0;
    editing_->redo();
}

void Document::goToStep(int done) {
    while (doneSteps() > done && editing_->canUndo()) undo();
    while (doneSteps() < done && editing_->canRedo()) redo();
}

}  // namespace hairloom::editor
