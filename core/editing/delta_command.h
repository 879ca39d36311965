// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The command of strokes and of everything else that touches some strands or some of the scalp.

#include <memory>
#include <string>

#include "core/editing/attribute_delta.h"
#include "core/editing/command.h"
#include "core/editing/dye_delta.h"
#include "core/editing/point_delta.h"
#include "core/editing/root_delta.h"
#include "core/editing/scalp_delta.h"
#include "core/editing/strand_delta.h"

namespace hairloom::editing {

/// Strands are named as before they came or went.
struct Deltas {
    PointDelta points;
    FlagDelta frozen{attribute::kFrozen};
    FlagDelta hidden{attribute::kHidden};
    FlagDelta selected{attribute::kSelected};
    FaceDelta faces;
    DensityDelta density;
    DyeDelta dye;
    AttributeDelta mask{AttributeDelta::Of::strands};
    AttributeDelta widths{AttributeDelta::Of::points};  ///< the attribute `width_change`
    RootDelta roots;
    StrandDelta strands;  ///< last in doing, first in undoing
    bool empty() const {
        return points.empty() && frozen.empty() && hidden.empty() && selected.empty() && faces.empty() &&
               density.empty() && dye.empty() && mask.empty() && widths.empty() && roots.empty() &&
               strands.empty();
    }
};

/// A command that has been carried out; null where the deltas are empty.
std::unique_ptr<Command> commandOf(std::string name, Deltas deltas);

}  // namespace hairloom::editing
