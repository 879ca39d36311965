// SPDX-License-Identifier: MIT
// How a body that bones move is found, for a place of each lane (docs/engine.md, "Bodies").
#if defined(HAIRLOOM_RUNTIME_ROD_BODY_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HAIRLOOM_RUNTIME_ROD_BODY_INL_H
#undef HAIRLOOM_RUNTIME_ROD_BODY_INL_H
#else
#define HAIRLOOM_RUNTIME_ROD_BODY_INL_H
#endif

#include <bit>
#include <cstring>
#include <limits>

#include "engine/body_free.h"
#include "engine/body_sample-inl.h"
#include "engine/lanes-inl.h"
#include "engine/moving_body.h"
#include "hwy/highway.h"
#include "models/rods/rod_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hairloom::runtime {
namespace HWY_NAMESPACE {

constexpr float kOutOfReach = std::numeric_limits<float>::infinity();

/// BonePose for each lane.
struct LanePose {
    V3 x, y, z, origin;
    V3 apply(V3 p) const { return mad3(x, p.x, mad3(y, p.y, mad3(z, p.z, origin))); }
};
HWY_INLINE LanePose allPose(const BonePose& pose) {
    return {all3(pose.x), all3(pose.y), all3(pose.z), all3(pose.origin)};
}
HWY_INLINE void putPose(RodMask which, const BonePose& pose, LanePose& to) {
    to.x = select(which, all3(pose.x), to.x);
    to.y = select(which, all3(pose.y), to.y);
    to.z = select(which, all3(pose.z), to.z);
    to.origin = select(which, all3(pose.origin), to.origin);
}

/// MovingBody::Carrier of each lane.
struct LaneCarrier {
    LanePose inverse, inverseBefore, before;
    V largest, least, apart, strayed, bone, number;
    RodMask usable;
};

/// `number`: of each lane's carrier; below 0 for none, which is as the first.
HWY_INLINE LaneCarrier carrierOfLanes(std::span<const MovingBody::Carrier> carriers, V number) {
    const MovingBody::Carrier& first = carriers[0];
    LaneCarrier of{allPose(first.inverse),
                   allPose(first.inverseBefore),
                   allPose(first.before),
                   all(first.largest),
                   all(first.least),
                   all(first.apart),
                   all(first.strayed),
                   all(static_cast<float>(first.bone)),
                   hn::Max(number, hn::Zero(D())),
                   first.usable ? hn::Not(noLane()) : noLane()};
    if (HWY_LIKELY(hn::AllFalse(D(), number > hn::Zero(D())))) return of;
    for (std::size_t c = 1; c < carriers.size(); ++c) {
        const auto which = number == all(static_cast<float>(c));
        if (hn::AllFalse(D(), which)) continue;
        const MovingBody::Carrier& own = carriers[c];
        putPose(which, own.inverse, of.inverse);
        putPose(which, own.inverseBefore, of.inverseBefore);
        putPose(which, own.before, of.before);
        of.largest = choose(which, all(own.largest), of.largest);
        of.least = choose(which, all(own.least), of.least);
        of.apart = choose(which, all(own.apart), of.apart);
        of.strayed = choose(which, all(own.strayed), of.strayed);
        of.bone = choose(which, all(static_cast<float>(own.bone)), of.bone);
        of.usable = own.usable ? either(of.usable, which) : hn::AndNot(which, of.usable);
    }
    return of;
}

/// Numbers of a vector's lanes, one by one.
struct SplitLanes {
    alignas(64) float at[3][kWidth];

    explicit SplitLanes(V3 v) {
        hn::Store(v.x, D(), at[0]);
        hn::Store(v.y, D(), at[1]);
        hn::Store(v.z, D(), at[2]);
    }
    Float3 operator[](std::size_t lane) const { return {at[0][lane], at[1][lane], at[2][lane]}; }
    void set(std::size_t lane, Float3 v) {
        at[0][lane] = v.x;
        at[1][lane] = v.y;
        at[2][lane] = v.z;
    }
    V3 all() const { return {hn::Load(D(), at[0]), hn::Load(D(), at[1]), hn::Load(D(), at[2])}; }
};
struct Lanes1 {
    alignas(64) float at[kWidth];

    explicit Lanes1(V v) { hn::Store(v, D(), at); }
    V all() const { return hn::Load(D(), at); }
};

/// Of a map that is not flat: rows of what undoes its linear part.
struct LaneUndone {
    V3 x, y, z;

    explicit LaneUndone(const LanePose& pose) {
        const V inverse = all(1.0f) / dot(pose.x, cross(pose.y, pose.z));
        x = cross(pose.y, pose.z) * inverse;
        y = cross(pose.z, pose.x) * inverse;
        z = cross(pose.x, pose.y) * inverse;
    }
    V3 apply(V3 v) const { return {dot(x, v), dot(y, v), dot(z, v)}; }
    /// Of a gradient, to the world.
    V3 transposed(V3 g) const { return mad3(x, g.x, mad3(y, g.y, z * g.z)); }
};

/// As isFlatPose() tells.
HWY_INLINE RodMask isRound(const LanePose& pose) {
    const V size = hn::Sqrt(dot(pose.x, pose.x) * dot(pose.y, pose.y) * dot(pose.z, pose.z));
    const V volume = hn::Abs(dot(pose.x, cross(pose.y, pose.z)));
    return both(both(volume > size * all(1e-3f), size > all(1e-9f)), size < all(kOutOfReach));
}

/// Metres from a box at least, 0 in it.
HWY_INLINE V besideBox(const BodyField::Box& box, V3 p) {
    const auto beside = [](V at, float low, float high) { return hn::Max(all(low) - at, at - all(high)); };
    return hn::Max(hn::Max(beside(p.x, box.low.x, box.high.x), beside(p.y, box.low.y, box.high.y)),
                   hn::Max(beside(p.z, box.low.z, box.high.z), hn::Zero(D())));
}

/// nearestCorner() of places within the table, and of those beyond it.
struct LaneCorner {
    BodyWords index;
    V away;  ///< in cells
};
HWY_INLINE LaneCorner cornerOfLanes(const BodyField& field, V3 cells) {
    const auto along = [&](V at, std::size_t axis) {
        const V most = all(static_cast<float>(field.size[axis]));
        return hn::ConvertTo(BodyInts(), hn::Min(hn::Max(at, hn::Zero(D())) + all(0.5f), most));
    };
    const BodyWords x = along(cells.x, 0), y = along(cells.y, 1), z = along(cells.z, 2);
    const V3 off = cells - V3{hn::ConvertTo(D(), x), hn::ConvertTo(D(), y), hn::ConvertTo(D(), z)};
    const BodyWords row = allWords(static_cast<std::int32_t>(field.size[0] + 1));
    const BodyWords layer = allWords(static_cast<std::int32_t>(field.size[1] + 1));
    return {(z * layer + y) * row + x, hn::Sqrt(dot(off, off))};
}

/// As BodyField::freeAround().
HWY_INLINE V freeOfLanes(const MovingBody& body, V3 rest) {
    const BodyField& field = body.field();
    const auto lengthOf = [&](std::size_t axis) { return static_cast<float>(field.size[axis]); };
    const Float3 size{lengthOf(0), lengthOf(1), lengthOf(2)};
    const V zero = hn::Zero(D());
    const V3 cells = (rest - all3(field.low_ss)) * all(1 / field.cell);
    const auto within = [&](V at, float most) { return both(at >= zero, at <= all(most)); };
    const auto inside = both(within(cells.x, size.x), both(within(cells.y, size.y), within(cells.z, size.z)));
    const LaneCorner corner = cornerOfLanes(field, onlyWhere(inside, cells));
    const BodyWords pair = wordsAt(body.table().pairs, corner.index);
    const V there = hn::ConvertTo(D(), hn::ShiftRight<16>(hn::ShiftLeft<16>(pair))) - all(0.5f);
    const V free = hn::Max(negMad(corner.away, all(1.0001f * field.cell), there * all(field.unit)), zero);
    if (HWY_LIKELY(hn::AllTrue(D(), inside))) return free;
    return choose(inside, free, besideBox({field.low_ss, field.low_ss + size * field.cell}, rest));
}

/// Of 255, as shareOf() tells.
HWY_INLINE V shareOfLanes(const MovingBody& body, std::size_t bone, V3 rest) {
    const BodyField& field = body.field();
    const V3 cells = (rest - all3(field.low_ss)) * all(1 / field.cell);
    const auto sound = dot(cells, cells) < all(1e12f);
    const LaneCorner corner = cornerOfLanes(field, onlyWhere(sound, cells));
    const BodyWords skin = wordsAt(body.table().skins, corner.index);
    const BodyWords bones = wordsAt(body.table().skinBones, skin);
    const BodyWords weights = wordsAt(body.table().skinWeights, skin);
    const BodyWords own = allWords(static_cast<std::int32_t>(bone)), byte = allWords(0xff);
    BodyWords share = hn::Zero(BodyInts());
    const auto add = [&](BodyWords bonesThere, BodyWords weightsThere) {
        share = share + hn::IfThenElseZero(hn::And(bonesThere, byte) == own, hn::And(weightsThere, byte));
    };
    add(bones, weights);
    add(hn::ShiftRight<8>(bones), hn::ShiftRight<8>(weights));
    add(hn::ShiftRight<16>(bones), hn::ShiftRight<16>(weights));
    add(hn::ShiftRight<24>(bones), hn::ShiftRight<24>(weights));
    return hn::ConvertTo(D(), share);
}

/// As PosedBody::poseAt(), of lanes in `bits`; others keep theirs.
HWY_INLINE void poseOfLanes(const MovingBody& body, const PosedBody& posed, V3 rest, std::uint32_t bits,
                            LanePose& pose) {
    const std::span<const BonePose> palette = posed.palette();
    if (palette.size() == 1) {
        putPose(maskOf(bits), palette[0], pose);
        return;
    }
    const BodyField& field = body.field();
    const auto lengthOf = [&](std::size_t axis) { return static_cast<float>(field.size[axis]); };
    const V one = all(1.0f);
    const BodyPlace place = bodyPlaceAt((rest - all3(field.low_ss)) * all(1 / field.cell),
                                        all3({lengthOf(0), lengthOf(1), lengthOf(2)}) - V3{one, one, one});
    const auto row = static_cast<std::int32_t>(field.size[0] + 1);
    const auto layer = row * static_cast<std::int32_t>(field.size[1] + 1);
    alignas(64) std::int32_t corners[kWidth];
    hn::Store(place.z * allWords(layer) + place.y * allWords(row) + place.x, BodyInts(), corners);
    // As Trilinear::weights() has it.
    alignas(64) float weights[8][kWidth];
    const V x = place.in.x, y = place.in.y, z = place.in.z, a = one - x, b = one - y, c = one - z;
    const V ab = a * b, xb = x * b, ay = a * y, xy = x * y;
    const V shares[8] = {ab * c, xb * c, ay * c, xy * c, ab * z, xb * z, ay * z, xy * z};
    for (int k = 0; k < 8; ++k) hn::Store(shares[k], D(), weights[k]);
    // A pose is twelve numbers, up to four of which are reckoned at once.
    static_assert(sizeof(BonePose) == 12 * sizeof(float) && sizeof(LanePose) == 12 * sizeof(V));
    const hn::CappedTag<float, 4> four;
    constexpr std::size_t kAtOnce = hn::MaxLanes(four);
    alignas(64) float numbers[12][kWidth];
    std::memcpy(numbers, &pose, sizeof(numbers));
    const std::int32_t steps[8] = {0, 1, row, row + 1, layer, layer + 1, layer + row, layer + row + 1};
    for (; bits != 0; bits &= bits - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(bits));
        const std::uint16_t* const skins = field.skins.data() + corners[lane];
        bool same = true;
        for (const std::int32_t step : steps) same = same && skins[step] == skins[0];
        const float* const only = &palette[skins[0]].x.x;
        alignas(16) float own[12];
        for (std::size_t part = 0; part < 12; part += kAtOnce) {
            auto sum = hn::LoadU(four, only + part);
            if (!same) {
                sum = hn::Zero(four);
                for (int k = 0; k < 8; ++k)
                    sum = hn::Add(sum, hn::Mul(hn::Set(four, weights[k][lane]),
                                               hn::LoadU(four, &palette[skins[steps[k]]].x.x + part)));
            }
            hn::Store(sum, four, own + part);
        }
        for (std::size_t k = 0; k < 12; ++k) numbers[k][lane] = own[k];
    }
    std::memcpy(&pose, numbers, sizeof(numbers));
}

/// Where skin takes places in the world from, by repeated substitution from `rest` on. Skin between two bones
/// turns along one line, on which two steps tell where all others lead (Anderson's mixing of two). Gives
/// back lanes where it settles. No lane hangs on another.
HWY_INLINE RodMask followOfLanes(const MovingBody& body, const PosedBody& posed, V3 point_ws, RodMask lanes,
                                 V3& rest, LanePose& map) {
    constexpr int kMostRounds = 12;
    constexpr float kIsSettled = 1e-5f, kIsLost = 2e-3f;  // metres
    V3 stepBefore = zero3(), nextBefore = zero3();
    V off = all(kOutOfReach);
    auto going = lanes;
    for (int round = 0; round < kMostRounds; ++round) {
        poseOfLanes(body, posed, rest, bitsOf(going), map);
        const V3 next = LaneUndone(map).apply(point_ws - map.origin);
        const V3 step = next - rest, turned = step - stepBefore;
        off = choose(going, hn::Sqrt(dot(step, step)), off);
        rest = select(going, next, rest);
        going = both(going, off > all(kIsSettled));
        if (hn::AllFalse(D(), going)) break;
        if (round > 0) {
            const V share = dot(step, turned) / dot(turned, turned);
            rest = select(both(going, hn::Abs(share) <= all(2.0f)), negMad3(next - nextBefore, share, next),
                          rest);
        }
        stepBefore = step;
        nextBefore = next;
    }
    return both(both(lanes, off < all(kIsLost)), isRound(map));
}

/// PosedBody::at() of each lane; nothing is known of lanes whose distance is infinite.
struct LaneContact {
    V distance;
    V3 normal, rest;
    V bone;  ///< as of BodySample
};
HWY_NOINLINE LaneContact contactOfLanes(const MovingBody& body, std::uint32_t substep, V3 position_ws,
                                        RodMask lanes) {
    constexpr float kMuch = 64.0f, kSlope = 1e-3f;  // of 255; per metre
    constexpr std::size_t kMostFound = 4;
    const BodyField& field = body.field();
    const std::span<const BonePose> inverses = body.inverses(substep);
    const std::span<const float> leasts = body.leasts(substep);
    float least = kOutOfReach;
    for (const float own : leasts) least = own > 0.0f ? std::min(least, own) : least;
    LaneContact nearest{all(kOutOfReach), zero3(), zero3(), all(-1.0f)};
    V3 found[kMostFound];
    for (V3& place : found) place = zero3();
    V count = hn::Zero(D());
    const auto isFound = [&](std::size_t bone, V3 rest) {
        auto is = noLane();
        for (std::size_t k = 0; k < kMostFound; ++k) {
            const auto known = count > all(static_cast<float>(k));
            if (hn::AllFalse(D(), known)) break;
            const V share = shareOfLanes(body, bone, found[k]);
            const V3 off = rest - found[k];
            const auto beside =
                both(share > hn::Zero(D()), dot(off, off) < all(field.cell) * all(field.cell));
            is = either(is, both(known, either(share >= all(kMuch), beside)));
        }
        return is;
    };
    for (const bool tryAll : {false, true}) {
        const auto left = tryAll ? both(lanes, count == hn::Zero(D())) : lanes;
        if (hn::AllFalse(D(), left)) break;
        for (std::size_t b = 0; b < inverses.size(); ++b) {
            if (!(leasts[b] > 0.0f)) continue;
            V3 rest = allPose(inverses[b]).apply(position_ws);
            auto tried = left;
            if (!field.boxes.empty()) tried = both(tried, besideBox(field.boxes[b], rest) <= hn::Zero(D()));
            if (hn::AllFalse(D(), tried)) continue;
            if (!tryAll) {
                tried = both(tried, shareOfLanes(body, b, rest) > hn::Zero(D()));
                tried = hn::AndNot(isFound(b, rest), tried);
            }
            // What one bone has shown is nearer than anything that another carries.
            tried = hn::AndNot(freeOfLanes(body, rest) * all(0.5f * least) > nearest.distance, tried);
            if (hn::AllFalse(D(), tried)) continue;
            LanePose map = allPose(BonePose{});
            const auto settled = followOfLanes(body, body.posed(substep + 1), position_ws, tried, rest, map);
            for (std::size_t k = 0; k < kMostFound; ++k)
                found[k] = select(both(settled, count == all(static_cast<float>(k))), rest, found[k]);
            count = choose(settled, count + all(1.0f), count);
            const BodySample sample = sampleBody(field, body.table(), rest);
            const V3 gradient = LaneUndone(map).transposed(sample.gradient);
            const V slope = hn::Sqrt(dot(gradient, gradient));
            // Bones that stretch the skin stretch what is before it. On the ridge between two sides the slope
            // vanishes: there is no way out that is the nearest.
            const V stretch = hn::Sqrt(dot(sample.gradient, sample.gradient)) / slope;
            const V distance = sample.distance * stretch;
            const auto closer =
                both(both(settled, sample.inside), both(slope > all(kSlope), distance < nearest.distance));
            nearest.distance = choose(closer, distance, nearest.distance);
            nearest.normal = select(closer, gradient * (all(1.0f) / slope), nearest.normal);
            nearest.rest = select(closer, rest, nearest.rest);
            nearest.bone = choose(closer, sample.bone, nearest.bone);
        }
    }
    return nearest;
}

/// What a look at the bones of a body has found.
struct LaneLook {
    V carried, other, number;  ///< as of BodySeen, and that of the carrier; the room is told from its side
    RodMask met;               ///< the body is near, and the rest is of it
    RodMask isCarried;  ///< what is near hangs on the carrier alone, and is to be measured in its space
    V3 normal, way;
    V distance, before;
};

/// What hangs on the carrier alone is as far as it is at rest; what hangs on other bones, too, lies in the
/// boxes of those, and skin between two bones may be closer than it was at rest, but hardly by half.
HWY_NOINLINE LaneLook lookOfLanes(const MovingBody& body, std::uint32_t substep, V3 position_ws,
                                  V3 displacement, V margin, RodMask lanes) {
    constexpr float kFarAway = 1e6f;  // metres
    const BodyField& field = body.field();
    const std::span<const BonePose> inverses = body.inverses(substep);
    const std::span<const float> leasts = body.leasts(substep);
    const std::span<const MovingBody::Carrier> carriers = body.carriers(substep);
    const bool isWhole = body.isWhole(substep), hasBoxes = !isWhole && !field.boxes.empty();
    const auto besideOf = [&](std::size_t b, V3 rest) {
        return hasBoxes ? besideBox(field.boxes[b], rest) * all(leasts[b]) : hn::Zero(D());
    };
    // The carrier whose skin may be nearest.
    V nearest = all(kOutOfReach), number = hn::Zero(D());
    for (std::size_t c = 0; c < carriers.size(); ++c) {
        if (!carriers[c].usable) continue;
        const std::size_t b = carriers[c].bone;
        const V3 rest = allPose(inverses[b]).apply(position_ws);
        const V beside = besideOf(b, rest);
        const auto nearer = both(lanes, beside < nearest);
        if (hn::AllFalse(D(), nearer)) continue;
        const V away = hn::Max(beside, freeOfLanes(body, rest) * all(leasts[b]));
        const auto nearestOne = both(nearer, away < nearest);
        nearest = choose(nearestOne, away, nearest);
        number = choose(nearestOne, all(static_cast<float>(c)), number);
        if (isWhole) break;
    }
    const LaneCarrier carrier = carrierOfLanes(carriers, number);
    const auto has = nearest < all(kOutOfReach);
    const V3 place = carrier.inverse.apply(position_ws);
    const V3 against = select(has, displacement - (position_ws - carrier.before.apply(place)), displacement);
    const V gone = hn::Sqrt(dot(against, against)), near = margin + gone;
    const V apart = choose(has, carrier.apart, gone);
    V other = choose(both(has, isWhole ? lanes : noLane()), nearest, all(kFarAway));
    for (std::size_t b = 0; b < inverses.size(); ++b) {
        if (!(leasts[b] > 0.0f)) continue;
        const auto beyond = isWhole
                                ? hn::AndNot(has, lanes)
                                : hn::AndNot(both(has, carrier.bone == all(static_cast<float>(b))), lanes);
        if (hn::AllFalse(D(), beyond)) continue;
        const V3 rest = allPose(inverses[b]).apply(position_ws);
        const V beside = besideOf(b, rest);
        const auto nearer = both(beyond, beside < other);
        if (hn::AllFalse(D(), nearer)) continue;
        const V away = hn::Max(beside, freeOfLanes(body, rest) * all(0.5f * leasts[b]));
        other = choose(nearer, hn::Min(other, away), other);
    }
    V carried = choose(has, nearest, other);
    LaneLook look{carried, other, number, noLane(), noLane(), zero3(), zero3(), hn::Zero(D()), hn::Zero(D())};
    const auto close = hn::AndNot(both(carried > near, other > near + apart), lanes);
    // A body that moves as a whole is looked up at rest wherever its table reaches.
    if (isWhole || hn::AllFalse(D(), close)) return look;

    const LaneContact contact = contactOfLanes(body, substep, position_ws, close);
    const auto told = both(close, contact.distance < all(kOutOfReach));
    const V fine =
        choose(contact.distance < all(BodyField::kFineReach), all(kBodyUnsureFine), all(kBodyUnsure));
    const V free = negMad(fine, all(body.cell()), contact.distance * all(kBodySure));
    look.carried = choose(told, hn::Max(carried, free), carried);
    look.other = choose(told, hn::Max(other, free), other);
    look.met = both(told, contact.distance <= near + apart);
    if (hn::AllFalse(D(), look.met)) return look;
    for (std::size_t c = 0; c < carriers.size(); ++c) {
        if (!carriers[c].usable) continue;
        const auto own = both(look.met, contact.bone == all(static_cast<float>(carriers[c].bone)));
        const auto turned = hn::AndNot(number == all(static_cast<float>(c)), own);
        look.isCarried = either(look.isCarried, own);
        look.carried = choose(turned, free, look.carried);
        look.other = choose(turned, free, look.other);
        look.number = choose(turned, all(static_cast<float>(c)), look.number);
    }
    look.met = hn::AndNot(look.isCarried, look.met);
    if (hn::AllFalse(D(), look.met)) return look;
    look.normal = contact.normal;
    look.distance = contact.distance;
    if (body.moves()) {
        LanePose was = allPose(BonePose{});
        poseOfLanes(body, body.posed(substep), contact.rest, bitsOf(look.met), was);
        look.way = position_ws - was.apply(contact.rest);
    }
    // By the plane that is there at the end; skin curves away from it.
    look.before = look.distance - dot(look.normal, displacement - look.way);
    return look;
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();
#endif
