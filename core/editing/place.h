// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Roots and strands on the scalp selection, all of them or only where it was painted.

#include <memory>
#include <vector>

#include "core/editing/command.h"
#include "core/editing/strand_maker.h"

namespace hairloom::editing {

struct PlaceRequest {
    /// Ascending; faces within the selection whose hair is placed anew. Empty: the whole selection, and hair
    /// that is rooted beside it goes as well.
    FaceSet region;
    /// Metres; new strands take the shape of hair that was there and no farther than this. 0: straight.
    float reach = 0;
};

/// Roots as the groom's placement settings, selection and density map call for. For a region with a number of
/// roots given, its share by (masked) area. With darts, no root is nearer to those that stay than they are to
/// each other. Errors: no head, an empty selection, nothing to place, as placeDarts().
Result<std::vector<SurfacePoint>> placeRoots(const Groom& groom, const PlaceRequest& request);

/// The step that replaces the hair of the region by strands on such roots and triangulates all roots; not
/// carried out yet.
Result<std::unique_ptr<Command>> place(const Groom& groom, const PlaceRequest& request, const KeepOut& skin);

}  // namespace hairloom::editing
