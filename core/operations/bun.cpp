// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/operations/bun.h"

#include <algorithm>
#include <cmath>

#include "core/base/smooth_step.h"
#include "core/operations/lay_along.h"
#include "core/operations/length_constraint.h"
#include "core/operations/operation.h"
#include "core/operations/strand_frames.h"

namespace hairloom {
namespace {

struct BunSettings {
    Vec3f centre = Vec3f::Zero();
    Vec3f axis = Vec3f::Zero();
    float radius = 0.028f;
    float thickness = 0.018f;
    float twist = 1.5f;
    float lift = 0.004f;
    float reach = 0;
    float clearance = 0.001f;
    std::uint64_t seed = 1;
};
using S = BunSettings;

constexpr Field<S> kFields[] = {
    field<&S::centre>("centre", "m", -kAnywhere, kAnywhere,
                      "centre of the bun, near the skin. Zero is high at the back of the head"),
    field<&S::axis>("axis", "", -kAnywhere, kAnywhere,
                    "axis of the winding. Zero points straight out of the skin"),
    field<&S::radius>("radius", "m", 0.005, 0.3, "distance from the axis to the middle of the roll"),
    field<&S::thickness>("thickness", "m", 0.002, 0.2, "radius of the roll"),
    field<&S::twist>("twist", "", -10, 10, "twists of the roll for each turn of the hair around the axis"),
    field<&S::lift>("lift", "m", 0, 0.1, "height above the skin of hair on its way to the bun"),
    field<&S::reach>("reach", "m", 0, kAnywhere,
                     "largest distance of a root from the centre: 0 winds all strands"),
    clearanceField<&S::clearance>(),
    seedField<&S::seed>("seed", "random seed of the positions within the roll"),
};
std::span<const Field<S>> fieldsOf(const S&) {
    return kFields;
}

struct Frame {
    Vec3f centre, axis, first, second;  ///< the roll lies in the plane of the last two
};

Frame frameOf(const BunPlace& place) {
    Frame frame{place.centre, place.axis, {}, {}};
    frame.first = unitOr(frame.axis.cross(Vec3f::UnitX()), frame.axis.unitOrthogonal());
    frame.second = frame.axis.cross(frame.first);
    return frame;
}

/// Enters the roll where it is nearest to the root, on its inside towards the skin, and goes around.
std::vector<Vec3f> around(const Frame& frame, const S& settings, const Vec3f& root, float length,
                          Random random) {
    const Vec3f from = root - frame.centre;
    const float begin = std::atan2(from.dot(frame.second), from.dot(frame.first));
    const float out = settings.thickness * std::sqrt(0.15f + 0.85f * random.uniform());
    const float place = kPi * (-0.5f + 0.45f * random.uniform(-1, 1));
    const float radius = settings.radius;
    constexpr float kStepDegrees = 8;
    std::vector<Vec3f> path;
    float arc = 0;
    for (int k = 0; arc < length && k < 20'000; ++k) {
        const float turn = radians(kStepDegrees) * static_cast<float>(k);
        const float rolled = place + settings.twist * turn;
        // Hair comes in flat from outside and reaches its place within a sixth of a round.
        const float in = smoothStep(0, kPi / 3, turn);
        const float wide = radius + out * std::cos(rolled) * in + (1 - in) * settings.thickness;
        const float high = out * std::sin(rolled) * in - (1 - in) * 0.8f * settings.thickness;
        const Vec3f round = std::cos(begin + turn) * frame.first + std::sin(begin + turn) * frame.second;
        path.push_back(frame.centre + wide * round + high * frame.axis);
        if (k > 0) arc += (path[path.size() - 1] - path[path.size() - 2]).norm();
    }
    return path;
}

Result<std::size_t> bun(Groom& groom, const S& settings, const Region& region) {
    if (auto status = checkFields("bun", settings); !status) return tl::unexpected(status.error());
    if (!groom.scalp) return fail("bun: the groom has no scalp", "bind it to one first");
    const Frame frame = frameOf(bunPlace(groom, settings.centre, settings.axis, settings.thickness));
    return editStrands(groom, region, {settings.clearance, Turns::asMade, true}, [&](StrandEdit& strand) {
        const Vec3f root = strand.points[0];
        if (settings.reach > 0 && (root - frame.centre).norm() > settings.reach) return;
        const std::vector<Vec3f> roll =
            around(frame, settings, root, strand.totalLength() + 0.01f, strand.random(settings.seed));
        std::vector<Vec3f> path = pathOverHead(*strand.outside, root, roll[0], settings.lift);
        path.insert(path.end(), roll.begin() + 1, roll.end());
        layAlong(strand.points, strand.lengths, std::move(path));
    });
}

}  // namespace

BunPlace bunPlace(const Groom& groom, const Vec3f& centre, const Vec3f& axis, float thickness) {
    const auto skin = sharedSkin(groom.scalp);
    const Box3f box = groom.scalp->bounds();
    const bool isFound = centre.isZero(0.0f);
    const Vec3f near = isFound ? Vec3f(box.center().x(), box.max().y(), box.min().z()) : centre;
    const auto sample = skin->skin().at(near);
    const Vec3f out = unitOr(axis, sample.outward);
    if (!isFound) return {centre, out};
    return {near - sample.distance * sample.outward + thickness * out, out};
}

Operation bunOperation() {
    return operation<S, bun>("bun", 74, "gathers hair and winds it into a bun");
}

}  // namespace hairloom
