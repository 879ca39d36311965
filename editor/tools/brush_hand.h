// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What all brushes have in common in a person's hand; kept in QSettings.

#include "core/base/math.h"
#include "editor/fields/option_form.h"

namespace hairloom::editor {

struct BrushHand {
    BrushHand();

    bool same = false;        ///< radius and strength are one for all brushes
    bool inPixels = false;    ///< the radius is that of the ring in the view, however far the hair
    bool throughHair = true;  ///< brushes reach all hair before the head
    float radius = 0;         ///< metres; 0 until one was set
    float radius_px = 0;      ///< 0 until it was seen in a view
    float strength = 0;

    /// Controls for the first three; `changed` is called after each change.
    void addOptions(OptionForm& form, bool worksOnSkin, const std::function<void()>& changed);
};

}  // namespace hairloom::editor
