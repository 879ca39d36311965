// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "editor/tools/tool.h"

namespace hairloom::editor {

class Session;

using ToolMaker = std::function<std::unique_ptr<Tool>(Session&)>;

/// One per tool, in the order of the tool bar.
std::vector<ToolMaker> toolMakers();

// Each in the file of its tool.
ToolMaker scalpBoxTool();
ToolMaker scalpLassoTool();
ToolMaker replaceTool();
ToolMaker strandSelectTool();
ToolMaker sphereTool();
ToolMaker windTool();
ToolMaker headTool();
/// The brushes of core/editing that work on the head, and those that work on hair.
std::vector<ToolMaker> headBrushes();
std::vector<ToolMaker> hairBrushes();

}  // namespace hairloom::editor
