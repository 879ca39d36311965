// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/replay.h"

#include <memory>
#include <utility>

#include "core/editing/document.h"
#include "core/editing/records.h"

namespace hairloom::editing {
namespace {

/// Held between the steps of one script, so that it is made once.
using HeldSkin = std::shared_ptr<const SkinField>;

void hold(const Document& document, HeldSkin& held) {
    if (document.heldSkin()) held = document.heldSkin();
}

Result<std::size_t> replayOn(Groom& groom, const Stroke& stroke, HeldSkin& held) {
    Document document(std::move(groom));
    auto touched = document.replay(stroke);
    hold(document, held);
    groom = std::move(document).takeGroom();
    return touched;
}

Result<std::size_t> performOn(Groom& groom, const MakeCommand& make, HeldSkin& held) {
    Document document(std::move(groom));
    auto command = make(document);
    const bool works = command.has_value();
    if (works) document.perform(std::move(*command));
    hold(document, held);
    groom = std::move(document).takeGroom();
    // How many strands a setting touches is nothing that a script reports.
    if (works) return 0;
    return tl::unexpected(command.error());
}

}  // namespace

std::vector<ScriptExtension> scriptExtensions() {
    const auto held = std::make_shared<HeldSkin>();
    const auto readStrokeStep = [held](JsonReader& reader) -> std::function<Result<std::size_t>(Groom&)> {
        return [held, stroke = readStroke(reader)](Groom& groom) { return replayOn(groom, stroke, *held); };
    };
    std::vector<ScriptExtension> extensions{{"stroke", readStrokeStep}};
    for (const RecordList& list : recordLists()) {
        for (const auto& [name, readRecord] : list) {
            extensions.push_back(
                {name,
                 [held, read = readRecord](JsonReader& reader) -> std::function<Result<std::size_t>(Groom&)> {
                     return
                         [held, make = read(reader)](Groom& groom) { return performOn(groom, make, *held); };
                 }});
        }
    }
    return extensions;
}

}  // namespace hairloom::editing
