// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/session.h"

namespace hairloom::editor {

Session::Session() : player(document) {}

}  // namespace hairloom::editor
