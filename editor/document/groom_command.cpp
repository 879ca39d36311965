// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/document/groom_command.h"

namespace hairloom::editor {
namespace {

std::size_t bytesNotShared(const AttributeSet& held, const AttributeSet& shown) {
    std::size_t bytes = 0;
    for (const auto& [name, data] : held.all()) {
        if (versionOf(data) == shown.version(name)) continue;
        bytes += std::visit([](const auto& array) { return array.view().size_bytes(); }, data);
    }
    return bytes;
}

}  // namespace

editing::Change GroomCommand::exchange(editing::Model& model) {
    std::swap(model.groom, other_);
    bytes_ = sizeof(*this) + bytesNotShared(other_.pointAttributes, model.groom.pointAttributes) +
             bytesNotShared(other_.strandAttributes, model.groom.strandAttributes) +
             (other_.offsets.sharesWith(model.groom.offsets) ? 0 : other_.offsets.view().size_bytes()) +
             other_.scalpSelection.size() * sizeof(std::uint32_t) +
             other_.scalpDensity.size() * sizeof(float) +
             other_.triangulation.triangles.size() * sizeof(Triangle);
    return {parts_, {}};
}

}  // namespace hairloom::editor
