// SPDX-License-Identifier: GPL-3.0-or-later
#include <vector>

#include "core/editing/brush_list.h"
#include "core/operations/curl.h"
#include "core/operations/length_constraint.h"

namespace hairloom::editing {
namespace {

constexpr BrushParameter kParameters[] = {
    parameter("curlRadius", "m", 0.0005, 0.05, 0.006f, "radius of the curls"),
    parameter("turns", "1/m", 1, 300, 25, "turns per metre of hair, limited to one turn per four segments"),
    parameter("variation", "", 0, 1, 0.1f,
              "1 starts each strand at a random angle, 0 starts all at the same angle"),
};
constexpr BrushInfo kInfo{
    .name = "curl",
    .label = "Curl",
    .meaning = "curls hair",
    .tip = "Drag to curl hair",
    .key = "J",
    .inverse = "curls hair the other way",
    .parameters = kParameters,
    .turnsSegments = true,
    .makesTurns = true,
    .order = 144,
};

class Curl final : public StrandBrush {
  public:
    const BrushInfo& info() const override { return kInfo; }

  protected:
    void beginDab(const StrokeTarget& target, const DabContext&) override {
        curls_.radius = target.parameter(kInfo, "curlRadius");
        curls_.frequency = target.parameter(kInfo, "turns");
        curls_.phaseVariation = target.parameter(kInfo, "variation");
        curls_.seed = target.settings.seed;
    }
    /// Towards the curls of the hair as the stroke found it, so that more dabs wind no tighter.
    bool edit(const DabContext& dab, StrandUnderBrush& strand) const override {
        std::vector<Vec3f> wound(strand.atStart.begin(), strand.atStart.end());
        std::vector<float> lengths;
        measureSegments(wound, lengths);
        // Left-handed curls are those of the mirrored strand.
        const auto reflect = [&] {
            for (Vec3f& point : wound) point.x() *= dab.sign;
        };
        reflect();
        curlStrand(wound, lengths, curls_,
                   2 * kPi * curls_.phaseVariation * strand.random(curls_.seed).uniform());
        reflect();
        strand.turnTowards(wound);
        return true;
    }

  private:
    CurlSettings curls_;
};

}  // namespace

BrushEntry curlBrush() {
    return brushEntry<Curl>(kInfo);
}

}  // namespace hairloom::editing
