// SPDX-License-Identifier: MIT
#include "engine/moving_body.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/body_free.h"
#include "shaders/rod_constants.h"

namespace hairloom::runtime {

namespace {

/// Metres that the linear part makes of one, at most (Gershgorin's bound on its square).
float stretchOf(const BonePose& pose) {
    const float xy = std::abs(dot(pose.x, pose.y)), yz = std::abs(dot(pose.y, pose.z)),
                zx = std::abs(dot(pose.z, pose.x));
    return std::sqrt(std::max(
        {dot(pose.x, pose.x) + xy + zx, dot(pose.y, pose.y) + xy + yz, dot(pose.z, pose.z) + yz + zx}));
}

/// How a bone goes from pose to pose: what takes a place before to the place after.
BonePose wayOf(const BonePose& before, const BonePose& after) {
    const BonePose back = inverseOf(before);
    const auto turned = [&](Float3 v) { return after.x * v.x + after.y * v.y + after.z * v.z; };
    return {turned(back.x), turned(back.y), turned(back.z), turned(back.origin) + after.origin};
}

/// Metres that two bones take what is within `reach` of a place apart.
float apart(const BonePose& a, const BonePose& b, Float3 around_ws, float reach) {
    const BonePose turn{a.x - b.x, a.y - b.y, a.z - b.z, {}};
    return length(a.apply(around_ws) - b.apply(around_ws)) + stretchOf(turn) * reach;
}

}  // namespace

void MovingBody::take(const BodyField& field, std::span<const BonePose> from, std::span<const BonePose> to,
                      std::size_t carrierBone, std::uint32_t substeps, Float3 around_ws, float reach) {
    field_ = &field;
    bones_ = to.size();
    const std::size_t c = carrier_ = std::min(carrierBone, bones_ - 1);
    inverses_.resize(substeps * bones_);
    leasts_.resize(substeps * bones_);
    at_.resize(std::size_t{substeps} + 1);
    carriers_.resize(substeps);
    between_.resize(to.size());
    before_.assign(from.begin(), from.end());
    // Sums of lengths lose their digits, and a carrier that is flat tells no place.
    constexpr float kFarStrayed = 0.5f;
    lostTrack_ = strayed_ > kFarStrayed || !std::isfinite(strayed_);
    if (lostTrack_) strayed_ = 0.0f;
    moves_ = !std::equal(from.begin(), from.end(), to.begin(), to.end());
    const auto mix = [](Float3 a, Float3 b, float t) { return a + (b - a) * t; };
    for (std::uint32_t i = 0; i <= substeps; ++i) {
        const float t = static_cast<float>(i) / static_cast<float>(substeps);
        for (std::size_t b = 0; b < to.size(); ++b) {
            between_[b] = i == substeps
                              ? to[b]
                              : BonePose{mix(from[b].x, to[b].x, t), mix(from[b].y, to[b].y, t),
                                         mix(from[b].z, to[b].z, t), mix(from[b].origin, to[b].origin, t)};
        }
        at_[i].take(field, between_);
        if (i == 0) continue;
        for (std::size_t b = 0; b < bones_; ++b) {
            const BonePose& pose = between_[b];
            const bool flat = isFlatPose(pose);
            leasts_[(i - 1) * bones_ + b] =
                flat ? 0.0f : std::min({length(pose.x), length(pose.y), length(pose.z)});
            inverses_[(i - 1) * bones_ + b] = flat ? BonePose{} : inverseOf(pose);
        }
        Carrier& carrier = carriers_[i - 1];
        carrier = {};
        if (isFlatPose(between_[c]) || isFlatPose(before_[c])) {
            strayed_ = carrier.apart = std::numeric_limits<float>::infinity();
        } else {
            const BonePose own = wayOf(before_[c], between_[c]);
            for (std::size_t b = 0; b < to.size(); ++b) {
                if (b == c || isFlatPose(before_[b]) || isFlatPose(between_[b])) continue;
                carrier.apart =
                    std::max(carrier.apart, apart(wayOf(before_[b], between_[b]), own, around_ws, reach));
            }
            strayed_ += carrier.apart;
            carrier.inverse = inverses_[(i - 1) * bones_ + c];
            carrier.step = {own.x - Float3{1, 0, 0}, own.y - Float3{0, 1, 0}, own.z - Float3{0, 0, 1},
                            own.origin};
        }
        carrier.largest = stretchOf(between_[c]);
        carrier.least = 1.0f / std::max(carrier.largest * stretchOf(carrier.inverse), 1.0f);
        carrier.strayed = strayed_;
        before_.swap(between_);
        between_.resize(to.size());
    }
}

/// Of the end of a substep. What hangs on the carrier alone is as far as it is at rest; what hangs on other
/// bones, too, lies in the boxes of those, and skin between two bones may be closer than it was at rest, but
/// hardly by half.
BodyRoom MovingBody::roomAround(std::uint32_t substep, Float3 point_ws) const {
    const BonePose* const inverses = inverses_.data() + substep * bones_;
    const float* const leasts = leasts_.data() + substep * bones_;
    constexpr float kFar = 1e6f;
    if (bones_ == 1 || !(leasts[carrier_] > 0.0f)) {
        const float away = std::min(at_[substep + 1].freeAround(point_ws), kFar);
        return {away, bones_ == 1 ? kFar : away};
    }
    BodyRoom room{leasts[carrier_] * field_->freeAround(inverses[carrier_].apply(point_ws)), kFar};
    for (std::size_t b = 0; b < bones_; ++b) {
        if (b == carrier_ || !(leasts[b] > 0.0f)) continue;
        const Float3 rest = inverses[b].apply(point_ws);
        const float beside = leasts[b] * distanceTo(field_->boxes[b], rest);
        if (beside >= room.other) continue;
        room.other = std::min(room.other, std::max(beside, 0.5f * leasts[b] * field_->freeAround(rest)));
    }
    return room;
}

bool MovingBody::touch(std::uint32_t substep, const BodyVisit& visit, BodyTouch& touch,
                       BodyRoom& room) const {
    const PosedBody& now = at_[substep + 1];
    const float farthest = visit.reach + visit.apart;
    room = roomAround(substep, visit.point_ws);
    if (room.carried > visit.reach && room.other > farthest) return false;
    const PosedBody::Contact contact = now.at(visit.point_ws);
    if (std::isfinite(contact.distance)) {
        const float free = surelyFree(contact.distance, now.cell());
        room = {std::max(room.carried, free), std::max(room.other, free)};
    }
    if (!(contact.distance <= farthest)) return false;
    touch.normal = contact.normal_ws;
    touch.distance = contact.distance;
    touch.way = moves_ ? visit.point_ws - at_[substep].place(contact.point_ss) : Float3{0.0f, 0.0f, 0.0f};
    // By the plane that is there at the end; skin curves away from it.
    touch.before = contact.distance - dot(touch.normal, visit.displacement - touch.way);
    if (touch.before < visit.radius - static_cast<float>(HAIRLOOM_ROD_CONTACT_DEEP))
        sweep(substep, visit, touch);
    return true;
}

/// Where the plane at the end has it inside at the start: whether it was, and if not, where it came in.
void MovingBody::sweep(std::uint32_t substep, const BodyVisit& visit, BodyTouch& touch) const {
    const Float3 moved = visit.displacement - touch.way;
    const PosedBody::Contact start = at_[substep].at(visit.point_ws - visit.displacement);
    touch.before = std::min(start.distance, visit.reach + visit.apart);
    const float whole = length(moved);
    if (touch.before < visit.radius || !(touch.distance < visit.radius) || !(whole > 0.0f)) return;
    // From place to place, as far as nothing is, along its way by the body as it is at the end.
    constexpr int kSteps = 16;
    constexpr float kThere = 1e-4f;  // metres
    float gone = 0.0f;
    for (int step = 0; step < kSteps; ++step) {
        const PosedBody::Contact contact =
            at_[substep + 1].at(visit.point_ws - moved * (1.0f - gone / whole));
        if (!std::isfinite(contact.distance)) return;
        const float room = contact.distance - visit.radius;
        if (room < kThere) {
            const float rest = dot(contact.normal_ws, moved) * (1.0f - gone / whole);
            // What leads out again is none that it came in by.
            if (rest >= 0.0f) return;
            touch.normal = contact.normal_ws;
            touch.distance = contact.distance + rest;
            return;
        }
        gone += room;
        if (gone >= whole) return;
    }
}

std::size_t carrierOf(const RestShape& shape, const BodyField& body) {
    std::vector<std::size_t> roots(std::max<std::size_t>(body.bones.size(), 1), 0);
    for (const RootFrame& root : shape.restRoots) {
        const Corner corner = nearestCorner(body, (root.position - body.low_ss) * (1 / body.cell));
        const BodyField::Skin& skin = body.palette[body.skins[corner.index]];
        const auto most = std::max_element(skin.weights.begin(), skin.weights.end());
        if (*most > 0) ++roots[skin.bones[static_cast<std::size_t>(most - skin.weights.begin())]];
    }
    return static_cast<std::size_t>(std::max_element(roots.begin(), roots.end()) - roots.begin());
}

Floats bodyClearances(const RestShape& shape, const BodyField& body) {
    Floats clearances(shape.planeFloats, 0.0f);
    for (const Block& block : shape.blocks) {
        const std::size_t size = planeSize(block);
        const float* const rest = shape.planes.data() + block.firstPlane * kRestPlanes;
        float* const own = clearances.data() + block.firstPlane;
        for (std::uint32_t lane = 0; lane < kBlockLanes; ++lane) {
            const RootFrame& root = shape.restRoots[block.strandOfLane[lane]];
            Float3 at = root.position;
            for (std::uint32_t p = 0; p < block.points; ++p) {
                const std::size_t i = std::size_t{p} * kBlockLanes + lane;
                own[i] = std::min(body.at(at).distance, 1.0f);
                at = at + rotate(root.rotation, Float3{rest[i], rest[size + i], rest[2 * size + i]});
            }
        }
    }
    return clearances;
}

}  // namespace hairloom::runtime
