// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Key this: the menu of a setting that can be keyed on the time line, and its mark.

#include <QLabel>

#include "editor/simulation/keying.h"

namespace hairloom::editor {

/// A right-click on these, or on what is in them, or the menu key, offers to key the setting "windSpeed" of
/// the simulation at the play head. Nothing where it cannot be keyed.
void offerKeys(Keying& keying, const char* setting, std::initializer_list<QWidget*> places);

/// Before the name of a setting: a diamond where it is keyed, filled where a key is at the play head.
QString keyMark(const Keying& keying, const char* setting);
/// "Keyed 3 times: 4.2 m/s at frame 20"; empty where it is not keyed.
QString keyTip(const Keying& keying, const char* setting);

}  // namespace hairloom::editor
