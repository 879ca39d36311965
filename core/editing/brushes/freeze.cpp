// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "core/editing/brush_list.h"
#include "core/editing/strand_finder.h"

namespace hairloom::editing {
namespace {

constexpr BrushParameter kParameters[] = {
    boolParameter("roots", false, "affects strands only by their roots"),
};
constexpr BrushInfo kInfo{
    .name = "freeze",
    .label = "Freeze",
    .meaning = "protects hair from other brushes",
    .tip = "Drag to protect hair from other brushes",
    .key = "Z",
    .inverse = "thaws hair",
    .parameters = kParameters,
    .order = 230,
};

/// Works on hair that is frozen already, or it could not be thawed.
class Freeze final : public Brush {
  public:
    const BrushInfo& info() const override { return kInfo; }

    Change dab(StrokeTarget& target, const DabContext& dab) override {
        const bool byRoots = target.parameter(kInfo, "roots") != 0;
        target.touched = strandsWithin(target.groom(), target.bounds, dab.volume, byRoots);
        std::erase_if(target.touched, [&](std::uint32_t s) { return isHidden(target.groom(), s); });
        target.changes.frozen.set(target.groom(), target.touched, dab.sign > 0);
        if (target.touched.empty()) return {};
        return {Part::StrandFlags, target.touched};
    }
};

}  // namespace

BrushEntry freezeBrush() {
    return brushEntry<Freeze>(kInfo);
}

}  // namespace hairloom::editing
