// SPDX-License-Identifier: MIT
#include "engine/moving_body.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "engine/body_free.h"
#include "hairloom/settings.h"
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

}  // namespace

void MovingBody::take(const BodyField& field, const BodyTable& table, std::span<const BonePose> from,
                      std::span<const BonePose> to, std::span<const std::uint32_t> carriers,
                      std::uint32_t substeps) {
    field_ = &field;
    table_ = &table;
    bones_ = to.size();
    carrierCount_ = std::min(carriers.size(), bones_);
    inverses_.resize(substeps * bones_);
    leasts_.resize(substeps * bones_);
    at_.resize(std::max(at_.size(), std::size_t{substeps} + 1));
    carriers_.resize(substeps * carrierCount_);
    wholes_.resize(substeps);
    between_.resize(bones_);
    before_.assign(from.begin(), from.end());
    starts_.assign(from.begin(), from.end());
    // Sums of lengths lose their digits, and a carrier that is flat tells no place.
    constexpr float kFarStrayed = 0.5f;
    lostTrack_ = std::any_of(strayed_.begin(), strayed_.end(),
                             [](float s) { return s > kFarStrayed || !std::isfinite(s); });
    if (lostTrack_) strayed_ = {};
    moves_ = !std::equal(from.begin(), from.end(), to.begin(), to.end());
    const auto isWhole = [](std::span<const BonePose> pose) {
        return std::all_of(pose.begin(), pose.end(), [&](const BonePose& b) { return b == pose[0]; });
    };
    const bool startsWhole = isWhole(from), endsWhole = isWhole(to);
    const auto mix = [](Float3 a, Float3 b, float t) { return a + (b - a) * t; };
    for (std::uint32_t i = 0; i <= substeps; ++i) {
        const float t = static_cast<float>(i) / static_cast<float>(substeps);
        for (std::size_t b = 0; b < bones_; ++b) {
            between_[b] = i == substeps
                              ? to[b]
                              : BonePose{mix(from[b].x, to[b].x, t), mix(from[b].y, to[b].y, t),
                                         mix(from[b].z, to[b].z, t), mix(from[b].origin, to[b].origin, t)};
        }
        at_[i].take(field, between_);
        if (i == 0) continue;
        wholes_[i - 1] = startsWhole && endsWhole ? 1 : 0;
        for (std::size_t b = 0; b < bones_; ++b) {
            const float least = leastStretch(between_[b]);
            leasts_[(i - 1) * bones_ + b] = least;
            inverses_[(i - 1) * bones_ + b] = least > 0.0f ? inverseOf(between_[b]) : BonePose{};
        }
        takeCarriers(i - 1, carriers, before_, between_);
        before_.swap(between_);
        between_.resize(bones_);
    }
}

void MovingBody::reserve(const BodyField& field, const BodyTable& table,
                         std::span<const std::uint32_t> carriers, std::uint32_t substeps) {
    // Bones that go apart need most.
    Vector<BonePose> poses(std::max<std::size_t>(field.bones.size(), 1));
    for (std::size_t b = 0; b < poses.size(); ++b) poses[b].origin.x = static_cast<float>(b);
    take(field, table, poses, poses, carriers, substeps);
    strayed_ = {};
    clear();
}

void MovingBody::takeCarriers(std::uint32_t substep, std::span<const std::uint32_t> bones,
                              std::span<const BonePose> before, std::span<const BonePose> after) {
    for (std::size_t c = 0; c < carrierCount_; ++c) {
        const std::size_t b = std::min<std::size_t>(bones[c], bones_ - 1);
        Carrier& carrier = carriers_[substep * carrierCount_ + c];
        carrier = {};
        carrier.bone = static_cast<std::uint32_t>(b);
        carrier.usable = !isFlatPose(before[b]) && !isFlatPose(after[b]);
        if (carrier.usable) {
            carrier.apart = stray(b, wayOf(before[b], after[b]), before, after);
            strayed_[c] += carrier.apart;
            carrier.before = before[b];
            carrier.inverseBefore = inverseOf(before[b]);
            carrier.inverse = inverses_[substep * bones_ + b];
            carrier.largest = std::max(stretchOf(after[b]), stretchOf(before[b]));
            carrier.least = 1.0f / std::max(carrier.largest * stretchOf(carrier.inverse), 1.0f);
        } else {
            strayed_[c] = std::numeric_limits<float>::infinity();
        }
        carrier.strayed = strayed_[c];
    }
}

/// Metres that what hangs on other bones goes against one in a substep, at most: what is between bones goes
/// no farther than what is on them, and that no farther than the corners of their boxes.
float MovingBody::stray(std::size_t carrier, const BonePose& way, std::span<const BonePose> before,
                        std::span<const BonePose> after) const {
    float most = 0.0f;
    for (std::size_t b = 0; b < std::min(bones_, field_->boxes.size()); ++b) {
        if (b == carrier || (after[b] == after[carrier] && before[b] == before[carrier])) continue;
        // What a flat bone would carry goes with the others, from when it is flat on.
        const bool flat = isFlatPose(after[b]);
        if (flat != isFlatPose(before[b])) return std::numeric_limits<float>::infinity();
        if (flat) continue;
        const BodyField::Box& box = field_->boxes[b];
        for (int corner = 0; corner < 8; ++corner) {
            const Float3 at{(corner & 1) != 0 ? box.high.x : box.low.x,
                            (corner & 2) != 0 ? box.high.y : box.low.y,
                            (corner & 4) != 0 ? box.high.z : box.low.z};
            most = std::max(most, length(after[b].apply(at) - way.apply(before[b].apply(at))));
        }
    }
    return most;
}

/// Where the plane at the end has it inside at the start: whether it was, and if not, where it came in.
void MovingBody::sweep(std::uint32_t substep, const BodyVisit& visit, float near, BodyTouch& touch) const {
    const Float3 moved = visit.displacement - touch.way;
    const PosedBody::Contact start = at_[substep].at(visit.point_ws - visit.displacement);
    touch.before = std::min(start.distance, near);
    const float whole = length(moved);
    // What lay on the skin is swept off it, too: far inside, the nearest way out may be on the other side.
    constexpr float kLay = 3e-3f, kSwept = 1e-3f;  // metres
    const float depth = visit.radius - touch.distance, inside = visit.radius - touch.before;
    if (!(depth > (inside > 0.0f ? kSwept : 0.0f)) || inside > kLay || !(whole > 0.0f)) return;
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

BodyWay bodyWay(const BodyField& field, std::span<const BonePose> given, std::span<const BonePose> known,
                float teleportDistance) {
    const auto isFinitePose = [](const BonePose& bone) {
        return isFinite(bone.x) && isFinite(bone.y) && isFinite(bone.z) && isFinite(bone.origin);
    };
    const bool fits = !given.empty() && (given.size() == 1 || given.size() == field.bones.size()) &&
                      std::all_of(given.begin(), given.end(), isFinitePose);
    BodyWay way;
    way.to = fits ? given : known;
    way.from = known.size() == way.to.size() ? known : way.to;
    for (std::size_t b = 0; b < way.to.size(); ++b) {
        if (length(way.to[b].origin - way.from[b].origin) > teleportDistance) {
            way.from = way.to;
            way.isCut = true;
        }
        way.moves = way.moves || !(way.to[b] == way.from[b]);
    }
    return way;
}

float leastStretch(const BonePose& pose) {
    return isFlatPose(pose) ? 0.0f : std::min({length(pose.x), length(pose.y), length(pose.z)});
}

std::uint32_t substepsBesideBody(float way, std::uint32_t usual) {
    constexpr float kFar = 0.025f, kNear = 0.01f;  // metres in a substep: too far, and what is wanted then
    if (!(way > kFar * static_cast<float>(usual)) || !std::isfinite(way)) return usual;
    const float wanted = std::min(std::ceil(way / kNear), static_cast<float>(kMostMoreSubsteps * usual));
    return std::clamp(static_cast<std::uint32_t>(wanted), usual, std::max(usual, kMaxSubsteps));
}

Vector<std::uint32_t> carriersOf(const RestShape& shape, const BodyField& body) {
    Vector<std::size_t> roots(std::max<std::size_t>(body.bones.size(), 1), 0), corners(roots);
    for (const RootFrame& root : shape.restRoots) {
        const Corner corner = nearestCorner(body, (root.position - body.low_ss) * (1 / body.cell));
        const BodyField::Skin& skin = body.palette[body.skins[corner.index]];
        const auto most = std::max_element(skin.weights.begin(), skin.weights.end());
        if (*most > 0) ++roots[skin.bones[static_cast<std::size_t>(most - skin.weights.begin())]];
    }
    constexpr std::uint8_t kAll = 255;
    for (const std::uint16_t index : body.skins) {
        const BodyField::Skin& skin = body.palette[index];
        for (std::size_t i = 0; i < skin.bones.size(); ++i)
            if (skin.weights[i] == kAll) ++corners[skin.bones[i]];
    }
    Vector<std::uint32_t> carriers(roots.size());
    std::iota(carriers.begin(), carriers.end(), 0u);
    std::sort(carriers.begin(), carriers.end(), [&](std::uint32_t a, std::uint32_t b) {
        return corners[a] != corners[b] ? corners[a] > corners[b] : a < b;
    });
    const auto first =
        std::max_element(carriers.begin(), carriers.end(),
                         [&](std::uint32_t a, std::uint32_t b) { return roots[a] < roots[b]; });
    std::rotate(carriers.begin(), first, first + 1);
    if (carriers.size() > MovingBody::kMostCarriers) carriers.resize(MovingBody::kMostCarriers);
    return carriers;
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
