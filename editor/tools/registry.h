// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>
#include <span>

#include "editor/tools/tool.h"

namespace hairloom::editor {

class Session;

using ToolMaker = std::unique_ptr<Tool> (*)(Session&);

/// One per tool, in the order of the tool bar.
std::span<const ToolMaker> toolMakers();

}  // namespace hairloom::editor
