// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QString>

#include "editor/document/preferences.h"

namespace hairloom::editor {

/// A length in metres with three figures, in the unit of the preferences: "42.9 cm".
QString lengthText(double metres, const Preferences& preferences);

}  // namespace hairloom::editor
