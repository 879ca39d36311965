// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/brush_list.h"
#include "core/editing/strand_finder.h"

namespace hairloom::editing {
namespace {

constexpr BrushParameter kParameters[] = {
    boolParameter("roots", true, "affects strands only by their roots; when off, by any part of them"),
};
constexpr BrushInfo kInfo{
    .name = "delete",
    .label = "Delete",
    .meaning = "deletes hair",
    .tip = "Drag to delete hair",
    .key = "D",
    .parameters = kParameters,
    .order = 210,
};

/// A dab hides strands, which is cheap and keeps their indices; they leave the groom when the stroke ends.
class Delete final : public Brush {
  public:
    const BrushInfo& info() const override { return kInfo; }

    Change dab(StrokeTarget& target, const DabContext& dab) override {
        const bool byRoots = target.parameter(kInfo, "roots") != 0;
        target.touched = strandsWithin(target.groom(), target.bounds, dab.volume, byRoots);
        std::erase_if(target.touched,
                      [&](std::uint32_t s) { return !target.editable[s] || isHidden(target.groom(), s); });
        target.changes.hidden.set(target.groom(), target.touched, true);
        if (target.touched.empty()) return {};
        return {Part::StrandFlags, target.touched};
    }

    Change finish(StrokeTarget& target) override {
        const auto doomed = target.changes.hidden.strands();
        if (doomed.empty()) return {};
        const std::vector<std::uint32_t> strands(doomed.begin(), doomed.end());
        target.changes.hidden.exchange(target.groom());
        target.changes.hidden = FlagDelta(attribute::kHidden);
        target.changes.strands.remove(target.groom(), strands);
        return {Part::Strands | Part::Triangulation, {}};
    }
};

}  // namespace

BrushEntry deleteBrush() {
    return brushEntry<Delete>(kInfo);
}

}  // namespace hairloom::editing
