// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What the parts of the window share: one document and everything that works on it.

#include "editor/document/document.h"
#include "editor/document/preferences.h"
#include "editor/document/tasks.h"
#include "editor/shell/messages.h"
#include "editor/simulation/player.h"
#include "editor/tools/tool_box.h"
#include "editor/viewport/viewport.h"

namespace hairloom::editor {

class Session {
  public:
    Session();

    Preferences preferences;
    Document document;
    Tasks tasks;
    Messages messages;
    Player player;
    Viewport* viewport = nullptr;  ///< the window owns it
    ToolBox tools;
};

}  // namespace hairloom::editor
