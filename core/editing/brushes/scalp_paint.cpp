// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <iterator>

#include "core/editing/brush_list.h"
#include "core/editing/surface_disc.h"

namespace hairloom::editing {
namespace {

constexpr BrushInfo kInfo{
    .name = "scalp_paint",
    .label = "Paint scalp",
    .meaning = "adds faces to the scalp, where hair grows",
    .tip = "Drag over the head to paint where hair grows",
    .key = "P",
    .inverse = "removes faces from the scalp",
    .needsHead = true,
    .worksOnSkin = true,
    .movesHair = false,
    .order = 10,
};

class ScalpPaint final : public Brush {
  public:
    const BrushInfo& info() const override { return kInfo; }

    Change dab(StrokeTarget& target, const DabContext& dab) override {
        target.touched.clear();
        const Groom& groom = target.groom();
        const FaceSet disc = faceDisc(*groom.scalp, *target.surface, dab.volume.centre, dab.volume.radius);
        FaceSet faces;
        if (dab.sign > 0) {
            std::set_union(groom.scalpSelection.begin(), groom.scalpSelection.end(), disc.begin(), disc.end(),
                           std::back_inserter(faces));
        } else {
            std::set_difference(groom.scalpSelection.begin(), groom.scalpSelection.end(), disc.begin(),
                                disc.end(), std::back_inserter(faces));
        }
        if (faces == groom.scalpSelection) return {};
        target.changes.faces.set(target.groom(), std::move(faces));
        return {Part::ScalpFaces, {}};
    }
};

}  // namespace

BrushEntry scalpPaintBrush() {
    return brushEntry<ScalpPaint>(kInfo);
}

}  // namespace hairloom::editing
