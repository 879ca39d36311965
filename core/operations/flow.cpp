// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/operations/flow.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/smooth_step.h"
#include "core/operations/head_places.h"
#include "core/operations/length_constraint.h"
#include "core/operations/operation.h"
#include "core/operations/strand_frames.h"

namespace hairloom {
namespace {

using S = FlowSettings;

constexpr Field<S> kFields[] = {
    field<&S::crown>(
        "crown", "m", -kAnywhere, kAnywhere,
        "point on the head that hair flows away from. Zero is a fifth behind the top of the head"),
    field<&S::whorlDegrees>("whorlDegrees", "°", -180, 180, "swirl of the flow near the crown"),
    field<&S::parting>("parting", "", 0, 1, "share of the flow that leads away from the parting plane"),
    field<&S::partingPoint>("partingPoint", "m", -kAnywhere, kAnywhere,
                            "centre of the parting. Zero is the top of the head"),
    field<&S::partingNormal>("partingNormal", "", -kAnywhere, kAnywhere,
                             "normal of the parting plane. Strands flow to the side of their root"),
    field<&S::partingReach>("partingReach", "m", 0.001, kAnywhere,
                            "distance from the centre at which the parting's share falls to 1/e"),
    field<&S::sweep>("sweep", "", -10, 10, "direction added to the flow, weighted by its length"),
    field<&S::gravity>("gravity", "", 0, 1, "share of straight down at the tip"),
    field<&S::fall>("fall", "", 0, 1, "share of straight down where the skin is steep"),
    field<&S::liftRoot>("liftRoot", "m", 0, 0.3,
                        "volume: height above the skin that hair rises to near its root"),
    field<&S::liftTip>("liftTip", "m", 0, 0.3, "height above the skin at the tip"),
    field<&S::rise>("rise", "m", 0.001, 1, "distance along the hair over which it rises"),
    field<&S::bend>("bend", "m", 0, 1,
                    "distance along the hair over which it bends into the flow: larger is rounder"),
    field<&S::variation>("variation", "", 0, 1, "largest random reduction of the lift per strand"),
    clearanceField<&S::clearance>(),
    seedField<&S::seed>("seed", "random seed of the variation"),
};
constexpr const char* kFormulaFields[] = {"whorlDegrees", "parting", "gravity", "fall",     "liftRoot",
                                          "liftTip",      "rise",    "bend",    "variation"};

// Metres on a head of a person.
constexpr float kWhorlReach = 0.04f;  ///< from the crown, at which the turn is down to 1/e
constexpr float kCrownBlur = 0.004f;  ///< at the crown itself the direction is random
constexpr float kHugReach = 0.02f;    ///< above its lift, over which hair lets go of the skin

constexpr float kSteepestClimb = 0.7f;  ///< sine of the angle at which hair seeks its height
constexpr float kSteepestSink = 0.4f;

/// Settings of a strand, and the head's size.
struct Laid : S {
    float scale = 1;  ///< headScale()
};

/// What a strand draws once.
struct Character {
    Vec3f blur;  ///< metres, added to the offset from the crown
    float liftScale;
    float side;     ///< of the parting, ±1
    float parting;  ///< share of the parting at the root
};

Character characterOf(const StrandEdit& strand, const Laid& settings) {
    Random random = strand.random(settings.seed);
    const float x = random.uniform(-1, 1);
    const float z = random.uniform(-1, 1);
    Character character;
    character.blur = settings.scale * kCrownBlur * Vec3f(x, 0, z);
    character.liftScale = 1 - settings.variation * random.uniform();
    const Vec3f fromParting = strand.points[0] - settings.partingPoint;
    character.side = fromParting.dot(settings.partingNormal) < 0 ? -1.0f : 1.0f;
    const float reach = fromParting.norm() / settings.partingReach;
    character.parting = settings.parting * std::exp(-reach * reach);
    return character;
}

/// The flow before gravity; not of unit length.
Vec3f flowAt(const Vec3f& point, const Vec3f& outward, const Character& character, const Laid& settings) {
    const Vec3f offset = point - settings.crown + character.blur;
    const float turn =
        radians(settings.whorlDegrees) * std::exp(-offset.norm() / (settings.scale * kWhorlReach));
    const Vec3f fromCrown =
        Eigen::AngleAxisf(turn, outward) * unitOr(offset - outward * offset.dot(outward), Vec3f::UnitX());
    const Vec3f fromParting = unitOr(settings.partingNormal, Vec3f::Zero()) * character.side;
    return fromCrown * (1 - character.parting) + fromParting * character.parting + settings.sweep;
}

struct Step {
    float arc;     ///< metres of hair at the segment's end
    float total;   ///< metres of hair
    float length;  ///< of the segment
};

/// Direction in which the next segment should lead.
Vec3f nextDirection(const Vec3f& point, const Vec3f& before, const Skin::Sample& skin, const Step& step,
                    const Character& character, const Laid& settings) {
    const Vec3f& n = skin.outward;
    const float t = step.arc / step.total;
    const float lift = character.liftScale *
                       (settings.liftRoot + t * (settings.liftTip - settings.liftRoot)) *
                       smoothStep(0, settings.rise, step.arc);
    const float steep = std::clamp(1 - n.y(), 0.0f, 1.0f);
    const float down = std::clamp(settings.gravity * t + settings.fall * steep, 0.0f, 1.0f);
    const Vec3f wanted =
        unitOr(flowAt(point, n, character, settings) * (1 - down) - Vec3f::UnitY() * down, before);

    // Hair hugs the skin at its height; it lets go where it is far away or where the skin overhangs.
    const float overhang = smoothStep(0.0f, -0.4f, n.y());
    const float hug =
        std::exp(-std::max(0.0f, skin.distance - lift) / (settings.scale * kHugReach)) * (1 - overhang);
    const float climb = std::clamp((lift - skin.distance) / step.length, -kSteepestSink, kSteepestClimb);
    float along = wanted.dot(n);
    along += hug * (climb - along);
    if (skin.distance < lift) along = std::max(along, climb);
    along = std::clamp(along, -1.0f, 1.0f);
    const Vec3f tangent =
        unitOr(wanted - n * wanted.dot(n), unitOr(before - n * before.dot(n), Vec3f::Zero()));
    return unitOr(tangent * std::sqrt(1 - along * along) + n * along, before);
}

void layStrand(StrandEdit& strand, const Laid& settings) {
    const Character character = characterOf(strand, settings);
    const Skin& skin = *strand.skin;
    Step step{0, strand.totalLength(), 0};
    if (!(step.total > 0)) return;
    Skin::Sample sample = skin.at(strand.points[0]);
    Vec3f direction = sample.outward;
    std::vector<float> turns(strand.points.size(), 1.0f);  // that the flow asks for, where the skin does not
    for (std::size_t i = 1; i < strand.points.size(); ++i) {
        step.length = strand.lengths[i - 1];
        step.arc += step.length;
        if (step.length > 0) {
            const Vec3f& from = strand.points[i - 1];
            const Vec3f next = nextDirection(from, direction, sample, step, character, settings);
            const float turn = settings.bend > 0 ? 1 - std::exp(-step.length / settings.bend) : 1.0f;
            const Vec3f last = direction;
            direction = unitOr(direction * (1 - turn) + next * turn, next);
            turns[i - 1] = last.dot(direction);
            const float clearance = std::min(settings.clearance, 0.5f * step.arc);
            strand.points[i] = placeOutside(*strand.outside, from, direction, step.length, clearance);
            direction = unitOr(strand.points[i] - from, direction);
            sample = skin.at(strand.points[i]);
        } else {
            strand.points[i] = strand.points[i - 1];
        }
    }
    settle(strand.points, strand.lengths, turns, strand.outside, settings.clearance);
}

}  // namespace

std::span<const Field<S>> fieldsOf(const S&) {
    return kFields;
}

namespace {

Result<std::size_t> flowVaried(Groom& groom, const Varied<S>& varied, const Region& region) {
    if (auto status = checkFields("flow", varied.base()); !status) return tl::unexpected(status.error());
    if (!groom.scalp) return fail("flow: the groom has no scalp", "bind it to one first");
    const S& asked = varied.base();
    const Vec3f crown = asked.crown.isZero(0) ? crownOfHead(groom) : asked.crown;
    const Vec3f parting = asked.partingPoint.isZero(0) ? topOfHead(groom) : asked.partingPoint;
    const float scale = headScale(groom);
    return editStrands(groom, region, {.turns = Turns::asMade, .needsSkin = true}, [&](StrandEdit& strand) {
        Laid settings{varied.at(strand.index), scale};
        settings.crown = crown;
        settings.partingPoint = parting;
        layStrand(strand, settings);
    });
}

}  // namespace

Result<std::size_t> flow(Groom& groom, const S& settings, const Region& region) {
    return flowVaried(groom, settings, region);
}

Operation flowOperation() {
    return variedOperation<S, flowVaried, kFormulaFields>(
        "flow", 20, "lays strands along the head from a crown, a parting or a sweep");
}

}  // namespace hairloom
