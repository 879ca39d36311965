// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/tools/tool_box.h"

#include <algorithm>
#include <iterator>

namespace hairloom::editor {

ToolBox::ToolBox(QObject* parent) : QObject(parent) {}
ToolBox::~ToolBox() = default;

void ToolBox::fill(const ToolParts& parts) {
    for (const ToolMaker make : toolMakers()) std::ranges::move(make(parts), std::back_inserter(tools_));
    std::ranges::stable_sort(tools_, {}, [](const auto& tool) { return tool->info().order; });
}

Tool* ToolBox::find(const QString& id) const {
    for (const auto& tool : tools_) {
        if (tool->info().id == id) return tool.get();
    }
    return nullptr;
}

void ToolBox::activate(Tool* tool) {
    if (tool == active_) return;
    active_ = tool;
    Q_EMIT activeChanged(tool);
}

}  // namespace hairloom::editor
