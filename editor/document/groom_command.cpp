// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/document/groom_command.h"

namespace hairloom::editor {
namespace {

constexpr int kMergeable = 1;

std::size_t bytesNotShared(const AttributeSet& before, const AttributeSet& after) {
    std::size_t bytes = 0;
    for (const auto& [name, data] : before.all()) {
        if (versionOf(data) == after.version(name)) continue;
        bytes += std::visit([](const auto& array) { return array.view().size_bytes(); }, data);
    }
    return bytes;
}

}  // namespace

GroomCommand::GroomCommand(Document& document, const QString& text, Changes changes, Groom after,
                           quint64 mergeKey)
    : QUndoCommand(text),
      document_(document),
      changes_(changes),
      before_(document.groom()),
      after_(std::move(after)),
      mergeKey_(mergeKey) {}

void GroomCommand::undo() {
    document_.set(before_, changes_);
}

void GroomCommand::redo() {
    document_.set(after_, changes_);
}

int GroomCommand::id() const {
    return mergeKey_ == 0 ? -1 : kMergeable;
}

bool GroomCommand::mergeWith(const QUndoCommand* next) {
    const auto* other = static_cast<const GroomCommand*>(next);
    if (other->mergeKey_ != mergeKey_) return false;
    after_ = other->after_;
    changes_ |= other->changes_;
    return true;
}

std::size_t GroomCommand::bytes() const {
    return bytesNotShared(before_.pointAttributes, after_.pointAttributes) +
           bytesNotShared(before_.strandAttributes, after_.strandAttributes) +
           (before_.offsets.sharesWith(after_.offsets) ? 0 : before_.offsets.view().size_bytes()) +
           (before_.scalpSelection.size() + after_.scalpSelection.size()) * sizeof(std::uint32_t) +
           before_.triangulation.triangles.size() * sizeof(Triangle) + sizeof(*this);
}

}  // namespace hairloom::editor
