// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/tools/registry.h"

namespace hairloom::editor {

std::vector<ToolMaker> toolMakers() {
    std::vector<ToolMaker> makers = headBrushes();
    makers.push_back(scalpBoxTool());
    makers.push_back(scalpLassoTool());
    makers.push_back(replaceTool());
    makers.push_back(strandSelectTool());
    for (ToolMaker& brush : hairBrushes()) makers.push_back(std::move(brush));
    makers.push_back(sphereTool());
    makers.push_back(windTool());
    makers.push_back(headTool());
    return makers;
}

}  // namespace hairloom::editor
