// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/operations/straighten.h"

#include <algorithm>
#include <vector>

#include "core/geometry/curve.h"
#include "core/operations/operation.h"
#include "core/operations/strand_frames.h"

namespace hairloom {
namespace {

struct StraightenSettings {
    float amount = 0.8f;
    float over = 0.08f;
    float clearance = 0.001f;
};
using S = StraightenSettings;

constexpr Field<S> kFields[] = {
    field<&S::amount>("amount", "", 0, 1, "how far strands turn to the straight course, as a share"),
    field<&S::over>("over", "m", 0, 5,
                    "bends up to this length are removed. Longer bends, such as the fall over the head, "
                    "stay. 0 straightens the whole strand"),
    clearanceField<&S::clearance>(),
};
constexpr const char* kFormulaFields[] = {"amount", "over"};
std::span<const Field<S>> fieldsOf(const S&) {
    return kFields;
}

/// The way from root to tip over a piece of hair around each segment.
class Course {
  public:
    Course(std::span<const Vec3f> points, std::span<const float> lengths)
        : points_(points), arcs_(points.size(), 0.0f) {
        for (std::size_t i = 1; i < points.size(); ++i) arcs_[i] = arcs_[i - 1] + lengths[i - 1];
    }
    float length() const { return arcs_.back(); }
    /// Of the segment that ends at point i.
    Vec3f around(std::size_t i, float over) const {
        const float middle = 0.5f * (arcs_[i - 1] + arcs_[i]);
        return at(middle + 0.5f * over) - at(middle - 0.5f * over);
    }

  private:
    Vec3f at(float arc) const {
        const auto behind = std::upper_bound(arcs_.begin() + 1, arcs_.end() - 1, arc);
        const auto i = static_cast<std::size_t>(behind - arcs_.begin());
        const float length = arcs_[i] - arcs_[i - 1];
        const float t = length > 0 ? std::clamp((arc - arcs_[i - 1]) / length, 0.0f, 1.0f) : 0.0f;
        return points_[i - 1] + t * (points_[i] - points_[i - 1]);
    }

    std::span<const Vec3f> points_;
    std::vector<float> arcs_;
};

}  // namespace

void straightenStrand(std::span<Vec3f> points, std::span<const float> lengths, float over, float amount) {
    const std::vector<Vec3f> before(points.begin(), points.end());
    const Course course(before, lengths);
    if (!(over > 0)) over = 2 * course.length();
    for (std::size_t i = 1; i < before.size(); ++i) {
        const Vec3f own = unitOr(before[i] - before[i - 1], -Vec3f::UnitY());
        const Vec3f straight = unitOr(course.around(i, over), own);
        const Quatf turn = Quatf::Identity().slerp(amount, shortestArc(own, straight));
        points[i] = points[i - 1] + (turn * own).normalized() * lengths[i - 1];
    }
}

namespace {

Result<std::size_t> straighten(Groom& groom, const Varied<S>& varied, const Region& region) {
    if (auto status = checkFields("straighten", varied.base()); !status)
        return tl::unexpected(status.error());
    return editStrands(groom, region, {varied.base().clearance}, [&](StrandEdit& strand) {
        const S settings = varied.at(strand.index);
        straightenStrand(strand.points, strand.lengths, settings.over, settings.amount);
    });
}

}  // namespace

Operation straightenOperation() {
    return variedOperation<S, straighten, kFormulaFields>("straighten", 62,
                                                          "removes waves and curls and keeps the fall");
}

}  // namespace hairloom
