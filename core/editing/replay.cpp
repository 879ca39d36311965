// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/replay.h"

#include <memory>
#include <utility>

#include "core/editing/document.h"

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

}  // namespace

std::vector<ScriptExtension> scriptExtensions() {
    const Shared shared = std::make_shared<Document::HeadData>();
    const auto readStrokeStep = [shared](JsonReader& reader) -> std::function<Result<std::size_t>(Groom&)> {
        return
            [shared, stroke = readStroke(reader)](Groom& groom) { return replayOn(groom, stroke, *shared); };
    };
    return {{"stroke", readStrokeStep}};
}

}  // namespace hairloom::editing
