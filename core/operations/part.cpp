// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/operations/part.h"

#include <cmath>

#include "core/base/smooth_step.h"
#include "core/operations/length_constraint.h"
#include "core/operations/operation.h"
#include "core/operations/strand_frames.h"

namespace hairloom {
namespace {

struct PartSettings {
    float strength = 1;
    float reach = 0.07f;
    float liftDegrees = 25;
    float rise = 0.03f;
    float clearance = 0.0015f;
    DrawnCurve curve;
};
using S = PartSettings;

constexpr Field<S> kFields[] = {
    field<&S::strength>("strength", "", 0, 1, "how strongly hair is laid away from the parting"),
    field<&S::reach>("reach", "m", 0.001, 1, "distance from the parting where the effect ends"),
    field<&S::liftDegrees>("liftDegrees", "°", 0, 90, "angle between hair and skin at the root"),
    field<&S::rise>("rise", "m", 0, 1, "distance from the root over which that angle fades"),
    clearanceField<&S::clearance>(),
};
constexpr const char* kFormulaFields[] = {"strength", "reach", "liftDegrees", "rise"};
std::span<const Field<S>> fieldsOf(const S&) {
    return kFields;
}

constexpr float kAway =
    0.9f;  ///< sine of the angle at which hair leads away from the parting, as far as skin lets it

/// Across the parting there, along the skin, to the right of its direction.
Vec3f across(const CurveLine::Nearest& place, const Vec3f& outward) {
    return unitOr(place.direction.cross(outward), place.direction.unitOrthogonal());
}

/// A direction whose share along the unit vector `axis` is at least `least`; the rest keeps its direction.
Vec3f raised(const Vec3f& direction, const Vec3f& axis, float least) {
    const float now = direction.dot(axis);
    if (now >= least) return direction;
    const Vec3f rest = unitOr(direction - axis * now, axis.unitOrthogonal());
    return axis * least + rest * std::sqrt(std::max(0.0f, 1 - least * least));
}

}  // namespace

bool layAwayFrom(const CurveLine& line, const PartingForce& force, std::span<Vec3f> points,
                 std::span<const float> lengths, const Vec3f& outward, const SkinQuery* skin) {
    const CurveLine::Nearest home = line.nearest(points[0]);
    if (home.distance >= force.reach) return false;
    const float side = (points[0] - home.point).dot(across(home, outward)) < 0 ? -1.0f : 1.0f;
    Vec3f last = points[0];
    Vec3f led = Vec3f::Zero(),
          ledBefore = Vec3f::Zero();  // directions of the last segment, now and as it was
    float arc = 0;
    for (std::size_t i = 1; i < points.size(); ++i) {
        arc += lengths[i - 1];
        Vec3f direction = unitOr(points[i] - last, outward);
        last = points[i];
        const Vec3f own = direction;
        const Vec3f& from = points[i - 1];
        const CurveLine::Nearest place = line.nearest(from);
        const float weight =
            force.strength * (1 - smoothStep(0.3f * force.reach, force.reach, place.distance));
        if (weight > 0) {
            const Vec3f normal = skin ? skin->distanceAt(from).outward : outward;
            const Vec3f away = side * across(place, normal);
            const float leads = direction.dot(away);
            direction = raised(direction, away, std::max(leads, leads + weight * (kAway - leads)));
            // The skin is met at the angle that the root leaves it, then along.
            const float lift = force.rise > 0 ? std::max(0.0f, 1 - arc / force.rise) : 0.0f;
            const float climb = std::sin(radians(force.liftDegrees)) * lift;
            const float rises = direction.dot(normal);
            const float wanted = rises + weight * (climb - rises);
            const Vec3f tangent = unitOr(direction - normal * rises, away);
            direction = tangent * std::sqrt(std::max(0.0f, 1 - wanted * wanted)) + normal * wanted;
        }
        direction = unitOr(direction, outward);
        if (i > 1) direction = turnedAsMay(led, direction, ledBefore.dot(own));
        led = direction;
        ledBefore = own;
        points[i] = from + direction * lengths[i - 1];
    }
    return true;
}

namespace {

Result<std::size_t> part(Groom& groom, const Varied<S>& varied, const Region& region) {
    if (auto status = checkFields("part", varied.base()); !status) return tl::unexpected(status.error());
    if (!CurveLine::isDrawn(varied.base().curve)) return std::size_t{0};
    const CurveLine line(varied.base().curve);
    const EditOptions options{varied.base().clearance, Turns::asBefore, true};
    return editStrands(groom, region, options, [&](StrandEdit& strand) {
        const S settings = varied.at(strand.index);
        const PartingForce force{settings.strength, settings.reach, settings.liftDegrees, settings.rise};
        layAwayFrom(line, force, strand.points, strand.lengths, strand.outward(), strand.skin);
    });
}

}  // namespace

Operation partOperation() {
    return variedOperation<S, part, kFormulaFields>("part", 22,
                                                    "lays strands away from a parting drawn on the scalp");
}

}  // namespace hairloom
