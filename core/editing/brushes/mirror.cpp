// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <optional>

#include "core/editing/brush_list.h"
#include "core/operations/clump_centres.h"
#include "core/operations/reshape.h"

namespace hairloom::editing {
namespace {

constexpr BrushParameter kParameters[] = {
    parameter("reach", "m", 0.001, 0.1, 0.02f,
              "largest distance from a mirrored root at which a strand copies its shape. Farther strands do "
              "not change"),
};
constexpr BrushInfo kInfo{
    .name = "mirror",
    .label = "Mirror",
    .meaning = "copies the shape of hair from the other side of the head",
    .tip = "Drag over hair to copy its shape from the other side",
    .key = "Shift+I",
    .parameters = kParameters,
    .keepsLengths = false,
    .order = 166,
};

class Mirror final : public StrandBrush {
  public:
    const BrushInfo& info() const override { return kInfo; }

  protected:
    void begin(StrokeTarget& target) override {
        before_ = target.groom();
        // The first dab need not pay for parting from the copy.
        target.groom().pointAttributes.edit<Vec3f>(attribute::kPosition);
        point_ = target.settings.mirrorPoint;
        normal_ = target.settings.mirrorNormal.normalized();
        reflect_ = Mat3f::Identity() - 2 * normal_ * normal_.transpose();
        const float reach = target.parameter(kInfo, "reach");
        for (auto& models : models_) models.emplace(before_, reach);
        for (std::uint32_t s = 0; s < before_.strandCount(); ++s) {
            const auto points = before_.strand(s);
            if (points.size() >= 2 && points[0].allFinite()) models_[heightOf(points[0]) > 0]->add(s);
        }
    }
    bool edit(const DabContext&, StrandUnderBrush& strand) const override {
        const Vec3f root = strand.points[0];
        const float height = heightOf(root);
        const std::uint32_t model = models_[!(height > 0)]->nearest(root - 2 * height * normal_);
        if (model == CentreGrid::kNone) return false;
        const auto shape = before_.strand(model);
        float weight = 0;
        for (std::size_t i = strand.first; i < strand.points.size(); ++i) {
            weight = std::max(weight, strand.weights[i]);
            const float t = static_cast<float>(i) / static_cast<float>(strand.points.size() - 1);
            const Vec3f wanted = root + reflect_ * (pointAlong(shape, t) - shape[0]);
            strand.points[i] += weight * (wanted - strand.points[i]);
        }
        return true;
    }

  private:
    float heightOf(const Vec3f& point) const { return (point - point_).dot(normal_); }

    Groom before_;
    std::array<std::optional<CentreGrid>, 2> models_;  ///< roots below the mirror plane, and above
    Vec3f point_ = Vec3f::Zero(), normal_ = Vec3f::UnitX();
    Mat3f reflect_ = Mat3f::Identity();
};

}  // namespace

BrushEntry mirrorBrush() {
    return brushEntry<Mirror>(kInfo);
}

}  // namespace hairloom::editing
