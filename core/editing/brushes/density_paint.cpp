// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "core/editing/brush_list.h"
#include "core/editing/surface_disc.h"

namespace hairloom::editing {
namespace {

constexpr BrushParameter kParameters[] = {
    parameter("density", "", 0, 1, 0, "root density to paint. Inverted, one minus this value"),
};
constexpr BrushInfo kInfo{
    .name = "density_paint",
    .label = "Paint density",
    .meaning = "paints the density of roots",
    .tip = "Drag over the scalp to paint how dense hair grows",
    .key = "Shift+P",
    .inverse = "paints one minus the value",
    .parameters = kParameters,
    .needsHead = true,
    .worksOnSkin = true,
    .movesHair = false,
    .order = 20,
};

class DensityPaint final : public Brush {
  public:
    const BrushInfo& info() const override { return kInfo; }

    Change dab(StrokeTarget& target, const DabContext& dab) override {
        target.touched.clear();
        const Groom& groom = target.groom();
        const VertexDisc disc =
            vertexDisc(*groom.scalp, *target.surface, dab.volume.centre, dab.volume.radius);
        const float painted = target.parameter(kInfo, "density");
        const float wanted = dab.sign > 0 ? painted : 1 - painted;
        std::vector<std::uint32_t> vertices;
        std::vector<float> values;
        for (std::size_t i = 0; i < disc.vertices.size(); ++i) {
            const std::uint32_t v = disc.vertices[i];
            const float now = groom.scalpDensity.empty() ? 1.0f : groom.scalpDensity[v];
            const float weight = dab.dab.strength * dab.dab.pressure *
                                 target.settings.falloff.at(disc.distances[i] / dab.volume.radius);
            const float value = std::clamp(now + weight * (wanted - now), 0.0f, 1.0f);
            if (value == now) continue;
            vertices.push_back(v);
            values.push_back(value);
        }
        if (vertices.empty()) return {};
        target.changes.density.set(target.groom(), vertices, values);
        return {Part::Density, {}};
    }
};

}  // namespace

BrushEntry densityPaintBrush() {
    return brushEntry<DensityPaint>(kInfo);
}

}  // namespace hairloom::editing
