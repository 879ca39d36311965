// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/tools/registry.h"

namespace hairloom::editor {

std::span<const ToolMaker> toolMakers() {
    return {};
}

}  // namespace hairloom::editor
