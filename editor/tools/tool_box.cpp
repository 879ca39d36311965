// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/tools/tool_box.h"

#include "editor/tools/registry.h"

namespace hairloom::editor {

ToolBox::ToolBox(QObject* parent) : QObject(parent) {}
ToolBox::~ToolBox() = default;

void ToolBox::fill(Session& session) {
    for (const ToolMaker& make : toolMakers()) tools_.push_back(make(session));
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
