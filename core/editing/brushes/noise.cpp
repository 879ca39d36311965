// SPDX-License-Identifier: GPL-3.0-or-later
#include <vector>

#include "core/editing/brush_list.h"
#include "core/operations/length_constraint.h"
#include "core/operations/noise.h"

namespace hairloom::editing {
namespace {

constexpr BrushParameter kParameters[] = {
    parameter("amplitude", "m", 0, 0.05, 0.006f, "size of the waves at the tip"),
    parameter("frequency", "1/m", 0, 1000, 20,
              "waves per metre of hair, limited to one wave per four segments"),
};
constexpr BrushInfo kInfo{
    .name = "noise",
    .label = "Noise",
    .meaning = "bends hair at random",
    .tip = "Drag to bend hair at random: many waves per metre give frizz, few give an uneven fall",
    .key = "V",
    .parameters = kParameters,
    .turnsSegments = true,
    .makesTurns = true,
    .order = 146,
};

class Noise final : public StrandBrush {
  public:
    const BrushInfo& info() const override { return kInfo; }

  protected:
    void beginDab(const StrokeTarget& target, const DabContext&) override {
        waves_.amplitude = target.parameter(kInfo, "amplitude");
        waves_.frequency = target.parameter(kInfo, "frequency");
        waves_.seed = target.settings.seed;
    }
    /// Towards the waves of the hair as the stroke found it, so that more dabs bend no wider.
    bool edit(const DabContext&, StrandUnderBrush& strand) const override {
        std::vector<Vec3f> bent(strand.atStart.begin(), strand.atStart.end());
        std::vector<float> lengths;
        measureSegments(bent, lengths);
        Random random = strand.random(waves_.seed);
        noiseStrand(bent, lengths, waves_, random.next());
        strand.turnTowards(bent);
        return true;
    }

  private:
    NoiseSettings waves_;
};

}  // namespace

BrushEntry noiseBrush() {
    return brushEntry<Noise>(kInfo);
}

}  // namespace hairloom::editing
