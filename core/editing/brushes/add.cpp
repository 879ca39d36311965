// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/base/parallel.h"
#include "core/editing/brush_list.h"
#include "core/editing/strand_maker.h"
#include "core/editing/surface_disc.h"

namespace hairloom::editing {
namespace {

constexpr std::size_t kGrain = 256;

constexpr BrushParameter kParameters[] = {
    parameter("density", "1/cm²", 0.01, 1000, 5, "largest density of roots that the brush fills to"),
    parameter("reach", "m", 0, 0.2, 0.03f,
              "new hair copies the shape of hair within this distance: 0 grows straight hair"),
};
constexpr BrushInfo kInfo{
    .name = "add",
    .label = "Add",
    .meaning = "adds hair between existing hair",
    .tip = "Drag over the scalp to add hair between existing hair",
    .key = "A",
    .parameters = kParameters,
    .needsHead = true,
    .worksOnSkin = true,
    .movesHair = false,
    .order = 200,
};

/// Throws darts at the disc under the dab: a root grows where no other is nearer than the density's distance.
/// Where part of the head is selected for hair, only there.
class Add final : public Brush {
  public:
    const BrushInfo& info() const override { return kInfo; }

    void begin(StrokeTarget& target) override {
        // Distance of a full Poisson-disk set of this density: each root fills r² / 0.7 of area.
        constexpr float kFilled = 0.7f;
        constexpr float kPerM2 = 1e4f;
        distance_ = std::sqrt(kFilled / (target.parameter(kInfo, "density") * kPerM2));
        reach_ = target.parameter(kInfo, "reach");
        grid_.emplace(gridOfRoots(target.groom(), std::max(distance_, 0.1f * reach_)));
        isSelected_.assign(target.groom().scalp->triangleCount(),
                           target.groom().scalpSelection.empty() ? 1 : 0);
        for (const std::uint32_t face : target.groom().scalpSelection) isSelected_[face] = 1;
    }

    Change dab(StrokeTarget& target, const DabContext& dab) override {
        target.touched.clear();
        const std::vector<SurfacePoint> roots = throwDarts(target, dab);
        if (roots.empty()) return {};
        Groom& groom = target.groom();
        const KeepOut skin{target.settings.collide ? target.skin : nullptr, target.settings.clearance};
        TakenStrands strands = makeStrands(groom, *grid_, roots, reach_, skin);
        target.touched = strands.indices;
        target.changes.strands.insert(groom, strands);
        target.bounds.append(groom);
        for (std::size_t k = 0; k < roots.size(); ++k)
            grid_->add(target.touched[k], groom.scalp->pointAt(roots[k].triangle, roots[k].barycentric));
        return {Part::Strands | Part::Triangulation, target.touched};
    }

  private:
    /// Where a dart meets the skin.
    struct Dart {
        SurfacePoint root;
        Vec3f place;
        bool isFree;  ///< within the dab, and no root that was there before is near
    };

    std::vector<SurfacePoint> throwDarts(const StrokeTarget& target, const DabContext& dab) const {
        const ScalpMesh& mesh = *target.groom().scalp;
        FaceSet faces = faceDisc(mesh, *target.surface, dab.volume.centre, dab.volume.radius);
        std::erase_if(faces, [&](std::uint32_t face) { return isSelected_[face] == 0; });
        std::vector<float> areas;
        float area = 0;
        for (const std::uint32_t face : faces) areas.push_back(area += mesh.triangleArea(face));
        if (!(area > 0)) return {};
        constexpr float kTriesPerPlace = 4;
        constexpr float kMaxTries = 20000;
        const float weight = dab.dab.strength * dab.dab.pressure;
        const auto tries = static_cast<std::size_t>(
            std::min(kMaxTries, std::ceil(weight * kTriesPerPlace * area / (distance_ * distance_))));
        Random random(target.settings.seed, 2 * dab.index + (dab.isMirror ? 1 : 0));
        std::vector<std::array<float, 3>> numbers(tries);
        for (auto& three : numbers)
            for (float& number : three) number = random.uniform();
        std::vector<Dart> darts(tries);
        parallelFor(tries, kGrain, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const auto chosen = std::upper_bound(areas.begin(), areas.end(), numbers[i][0] * area);
                const auto k = std::min(static_cast<std::size_t>(chosen - areas.begin()), faces.size() - 1);
                const float u = std::sqrt(numbers[i][1]), v = numbers[i][2];
                Dart& dart = darts[i];
                dart.root = {faces[k], Vec3f(1 - u, u * (1 - v), u * v)};
                dart.place = mesh.pointAt(dart.root.triangle, dart.root.barycentric);
                dart.isFree = !((dart.place - dab.volume.centre).norm() > dab.volume.radius) &&
                              !grid_->anyWithin(dart.place, distance_);
            }
        });
        return apart(darts);
    }

    /// One dart after the other that is free and not near one before it.
    std::vector<SurfacePoint> apart(std::span<const Dart> darts) const {
        RootGrid fresh(2 * distance_);
        std::vector<SurfacePoint> roots;
        for (const Dart& dart : darts) {
            if (!dart.isFree || fresh.anyWithin(dart.place, distance_)) continue;
            fresh.add(0, dart.place);
            roots.push_back(dart.root);
        }
        return roots;
    }

    float distance_ = 0;
    float reach_ = 0;
    std::optional<RootGrid> grid_;
    std::vector<std::uint8_t> isSelected_;
};

}  // namespace

BrushEntry addBrush() {
    return brushEntry<Add>(kInfo);
}

}  // namespace hairloom::editing
