// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/replay.h"

#include <memory>
#include <utility>

#include "core/editing/document.h"
#include "core/editing/records.h"

namespace hairloom::editing {
namespace {

/// What the steps of one script share.
using Shared = std::shared_ptr<Document::HeadData>;

Result<std::size_t> replayOn(Groom& groom, const Stroke& stroke, Document::HeadData& shared) {
    Document document(std::move(groom));
    if (shared.head == document.groom().scalp) document.setHeadData(shared);
    auto touched = document.replay(stroke);
    shared = document.headData();
    groom = std::move(document).takeGroom();
    return touched;
}

Result<std::size_t> performOn(Groom& groom, const MakeCommand& make, Document::HeadData& shared) {
    Document document(std::move(groom));
    if (shared.head == document.groom().scalp) document.setHeadData(shared);
    auto command = make(document);
    const bool works = command.has_value();
    if (works) document.perform(std::move(*command));
    shared = document.headData();
    groom = std::move(document).takeGroom();
    // How many strands a setting touches is nothing that a script reports.
    if (works) return 0;
    return tl::unexpected(command.error());
}

}  // namespace

std::vector<ScriptExtension> scriptExtensions() {
    const Shared shared = std::make_shared<Document::HeadData>();
    const auto readStrokeStep = [shared](JsonReader& reader) -> std::function<Result<std::size_t>(Groom&)> {
        return
            [shared, stroke = readStroke(reader)](Groom& groom) { return replayOn(groom, stroke, *shared); };
    };
    std::vector<ScriptExtension> extensions{{"stroke", readStrokeStep}};
    for (const RecordedOperation& operation : recordedOperations()) {
        extensions.push_back({operation.name,
                              [shared, read = operation.read](
                                  JsonReader& reader) -> std::function<Result<std::size_t>(Groom&)> {
                                  return [shared, make = read(reader)](Groom& groom) {
                                      return performOn(groom, make, *shared);
                                  };
                              }});
    }
    return extensions;
}

}  // namespace hairloom::editing
