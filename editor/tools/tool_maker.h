// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Making tools. A tool is a file of its own, tools/NAME_tool.cpp, with one function `ToolMaker nameTool()`;
// the list is made from the names of the files.

#include <memory>
#include <vector>

#include "editor/document/messages.h"
#include "editor/document/preferences.h"
#include "editor/document/qt_document.h"
#include "editor/simulation/player.h"
#include "editor/viewport/tool.h"
#include "editor/viewport/viewport.h"

namespace hairloom::editor {

/// What tools are made with; each keeps what it uses.
struct ToolParts {
    QtDocument& document;
    const Preferences& preferences;
    Messages& messages;
    Player& player;
    Viewport& viewport;
};

using Tools = std::vector<std::unique_ptr<Tool>>;
/// The tools of one file: most have one.
using ToolMaker = Tools (*)(const ToolParts&);

/// In order of file name (hairloom_registry).
const std::vector<ToolMaker>& toolMakers();

/// The tools of a file that has one, of that class.
template <class T, class... Arguments>
Tools oneTool(Arguments&... arguments) {
    Tools tools;
    tools.push_back(std::make_unique<T>(arguments...));
    return tools;
}

}  // namespace hairloom::editor
