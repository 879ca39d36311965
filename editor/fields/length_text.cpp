// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/fields/length_text.h"

#include "editor/fields/field.h"

namespace hairloom::editor {

QString lengthText(double metres, const Preferences& preferences) {
    constexpr double kAnyHead = 10;  // metres: large enough for the preferences to decide
    const Shown shown = shownAs("m", 0, kAnyHead, preferences.unit());
    return QStringLiteral("%1 %2").arg(metres * shown.factor, 0, 'g', 3).arg(shown.unit);
}

}  // namespace hairloom::editor
