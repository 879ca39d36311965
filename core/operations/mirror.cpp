// SPDX-License-Identifier: GPL-3.0-or-later
#include <vector>

#include "core/operations/clump_centres.h"
#include "core/operations/length_constraint.h"
#include "core/operations/operation.h"
#include "core/operations/reshape.h"

namespace hairloom {
namespace {

struct MirrorSettings {
    Vec3f planePoint = Vec3f::Zero();
    Vec3f planeNormal = Vec3f(1, 0, 0);
    float reach = 0.02f;
    float clearance = 0.001f;
};
using S = MirrorSettings;

constexpr Field<S> kFields[] = {
    field<&S::planePoint>("planePoint", "m", -kAnywhere, kAnywhere, "a point on the mirror plane"),
    field<&S::planeNormal>("planeNormal", "", -kAnywhere, kAnywhere,
                           "normal that points to the source side. Zero mirrors nothing"),
    field<&S::reach>("reach", "m", 0.0005, 1,
                     "largest distance from a mirrored root at which a strand copies its shape. Farther "
                     "strands do not change"),
    clearanceField<&S::clearance>(),
};
std::span<const Field<S>> fieldsOf(const S&) {
    return kFields;
}

/// A strand of the other side takes the shape of the one whose mirrored root is nearest, with its lengths.
Result<std::size_t> mirror(Groom& groom, const S& settings, const Region& region) {
    if (auto status = checkFields("mirror", settings); !status) return tl::unexpected(status.error());
    if (settings.planeNormal.isZero(0.0f)) return std::size_t{0};
    const Vec3f normal = settings.planeNormal.normalized();
    const Mat3f reflect = Mat3f::Identity() - 2 * normal * normal.transpose();
    const Groom before = groom;
    const auto height = [&](const Vec3f& point) { return (point - settings.planePoint).dot(normal); };
    CentreGrid models(before, settings.reach);
    for (std::uint32_t s = 0; s < before.strandCount(); ++s) {
        const auto points = before.strand(s);
        if (points.size() >= 2 && points[0].allFinite() && height(points[0]) > 0) models.add(s);
    }
    return editStrands(groom, region, {settings.clearance, Turns::asMade}, [&](StrandEdit& strand) {
        const Vec3f root = strand.points[0];
        if (!(height(root) < 0)) return;
        const std::uint32_t model = models.nearest(root - 2 * height(root) * normal);
        if (model == CentreGrid::kNone) return;
        const auto shape = before.strand(model);
        for (std::size_t i = 1; i < strand.points.size(); ++i) {
            const float t = static_cast<float>(i) / static_cast<float>(strand.points.size() - 1);
            strand.points[i] = root + reflect * (pointAlong(shape, t) - shape[0]);
        }
    });
}

}  // namespace

Operation mirrorOperation() {
    return operation<S, mirror>("mirror", 88, "copies the shape of hair from one side to the other");
}

}  // namespace hairloom
