// SPDX-License-Identifier: MIT
// Distances of a body at rest, for a place of each lane.
#if defined(HAIRLOOM_RUNTIME_BODY_SAMPLE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HAIRLOOM_RUNTIME_BODY_SAMPLE_INL_H
#undef HAIRLOOM_RUNTIME_BODY_SAMPLE_INL_H
#else
#define HAIRLOOM_RUNTIME_BODY_SAMPLE_INL_H
#endif

#include "engine/body_table.h"
#include "engine/lanes-inl.h"
#include "hairloom/memory.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace hairloom::runtime {
namespace HWY_NAMESPACE {

using BodyInts = hn::RebindToSigned<D>;
using BodyWords = hn::Vec<BodyInts>;

HWY_INLINE BodyWords allWords(std::int32_t value) {
    return hn::Set(BodyInts(), value);
}
HWY_INLINE BodyWords wordsAt(const Vector<std::int32_t>& table, BodyWords index) {
    return hn::GatherIndex(BodyInts(), table.data(), index);
}

/// As BodyField::at() tells, and what moves the skin there.
struct BodySample {
    hn::Mask<D> inside;  ///< of the table; nothing is known of other lanes
    V distance;          ///< metres at rest
    V3 gradient;
    V bone;  ///< its number, or BodyTable::kMixed
};

/// A cell of lanes: its number along each axis, and places in it from 0 to 1.
struct BodyPlace {
    BodyWords x, y, z;
    V3 in;
};
HWY_INLINE BodyPlace bodyPlaceAt(V3 at, V3 last) {
    const auto along = [](V place, V most) {
        return hn::ConvertTo(BodyInts(), hn::Min(hn::Max(place, hn::Zero(D())), most));
    };
    const BodyWords x = along(at.x, last.x), y = along(at.y, last.y), z = along(at.z, last.z);
    return {x, y, z, at - V3{hn::ConvertTo(D(), x), hn::ConvertTo(D(), y), hn::ConvertTo(D(), z)}};
}

/// Corners of a cell along x, then y, then z; in steps of `unit`. The gradient is in steps of the cell.
HWY_INLINE void bodyTrilinear(const V (&v)[8], V3 in, V unit, V& value, V3& gradient) {
    const V x00 = lerp(v[0], v[1], in.x), x10 = lerp(v[2], v[3], in.x), x01 = lerp(v[4], v[5], in.x),
            x11 = lerp(v[6], v[7], in.x);
    const V y0 = lerp(x00, x10, in.y), y1 = lerp(x01, x11, in.y);
    value = lerp(y0, y1, in.z) * unit;
    gradient = V3{lerp(lerp(v[1] - v[0], v[3] - v[2], in.y), lerp(v[5] - v[4], v[7] - v[6], in.y), in.z),
                  lerp(x10 - x00, x11 - x01, in.z), y1 - y0} *
               unit;
}

HWY_INLINE BodySample sampleBody(const BodyField& field, const BodyTable& table, V3 point_ss) {
    const auto lengthOf = [&](std::size_t axis) { return static_cast<float>(field.size[axis]); };
    const V3 size = all3({lengthOf(0), lengthOf(1), lengthOf(2)});
    const V perCell = all(1 / field.cell), zero = hn::Zero(D());
    V3 at = (point_ss - all3(field.low_ss)) * perCell;
    const auto within = [&](V place, V most) { return hn::And(place >= zero, place <= most); };
    const auto inside = hn::And(within(at.x, size.x), hn::And(within(at.y, size.y), within(at.z, size.z)));
    // No lane reads beyond the table, nor one that is no number.
    at = onlyWhere(inside, at);
    const V one = all(1.0f);
    const BodyPlace cell = bodyPlaceAt(at, {size.x - one, size.y - one, size.z - one});
    const auto nx = static_cast<std::int32_t>(field.size[0]), ny = static_cast<std::int32_t>(field.size[1]);
    const BodyWords entry = wordsAt(table.cells, (cell.z * allWords(ny) + cell.y) * allWords(nx) + cell.x);
    BodyWords block = hn::And(entry, allWords(0xffff));
    const V bone = hn::ConvertTo(D(), hn::And(hn::ShiftRight<16>(entry), allWords(0xff)));
    const auto has = hn::RebindMask(D(), block != allWords(BodyField::kNoBlock));
    BodySample sample{inside, zero, zero3(), bone};
    constexpr auto kFine = static_cast<float>(BodyField::kBlockCells);
    if (!hn::AllFalse(D(), has)) {
        block = hn::IfThenElseZero(hn::RebindMask(BodyInts(), has), block);
        const V3 last = all3({kFine - 1, kFine - 1, kFine - 1});
        BodyPlace place = bodyPlaceAt(cell.in * all(kFine), last);
        const auto quadOf = [](const BodyPlace& in) {
            return in.z * allWords(BodyTable::kLayer) + in.y * allWords(BodyTable::kRow) + in.x;
        };
        V steps = perCell * all(kFine);
        const auto refined = hn::And(
            has, hn::RebindMask(D(), hn::And(entry, allWords(BodyTable::kRefined)) != hn::Zero(BodyInts())));
        if (HWY_UNLIKELY(!hn::AllFalse(D(), refined))) {
            const auto words = hn::RebindMask(BodyInts(), refined);
            const BodyWords ours = hn::IfThenElseZero(words, block);
            // Lanes that are not refined read what some other one does.
            const BodyWords which = hn::IfThenElseZero(words, wordsAt(table.refinements, ours));
            const BodyWords own =
                wordsAt(table.finer, which * allWords(BodyTable::kRow * BodyTable::kLayer) + quadOf(place));
            const auto isFiner = hn::And(refined, hn::RebindMask(D(), own != allWords(BodyField::kNoBlock)));
            const BodyPlace inner = bodyPlaceAt(place.in * all(kFine), last);
            const auto finer = hn::RebindMask(BodyInts(), isFiner);
            place.x = hn::IfThenElse(finer, inner.x, place.x);
            place.y = hn::IfThenElse(finer, inner.y, place.y);
            place.z = hn::IfThenElse(finer, inner.z, place.z);
            place.in = select(isFiner, inner.in, place.in);
            block = hn::IfThenElse(finer, own, block);
            steps = hn::IfThenElse(isFiner, steps * all(kFine), steps);
        }
        const BodyWords quad = block * allWords(BodyTable::kBlockQuads) + quadOf(place);
        V corners[8];
        for (int layer = 0; layer < 2; ++layer) {
            const BodyWords four = wordsAt(table.quads, quad + allWords(layer * BodyTable::kLayer));
            corners[4 * layer] = hn::ConvertTo(D(), hn::ShiftRight<24>(hn::ShiftLeft<24>(four)));
            corners[4 * layer + 1] = hn::ConvertTo(D(), hn::ShiftRight<24>(hn::ShiftLeft<16>(four)));
            corners[4 * layer + 2] = hn::ConvertTo(D(), hn::ShiftRight<24>(hn::ShiftLeft<8>(four)));
            corners[4 * layer + 3] = hn::ConvertTo(D(), hn::ShiftRight<24>(four));
        }
        bodyTrilinear(corners, place.in, all(BodyField::kFineUnit), sample.distance, sample.gradient);
        sample.gradient = sample.gradient * steps;
    }
    const V away = hn::Abs(sample.distance);
    const auto beyond = hn::Or(hn::Not(has), away > all(BodyField::kFineReach));
    if (hn::AllFalse(D(), beyond)) return sample;
    const BodyWords row = allWords(nx + 1);
    const BodyWords corner = (cell.z * allWords(ny + 1) + cell.y) * row + cell.x;
    const BodyWords layer = allWords((nx + 1) * (ny + 1));
    V corners[8];
    const BodyWords from[4] = {corner, corner + row, corner + layer, corner + layer + row};
    for (int i = 0; i < 4; ++i) {
        const BodyWords pair = wordsAt(table.pairs, from[i]);
        corners[2 * i] = hn::ConvertTo(D(), hn::ShiftRight<16>(hn::ShiftLeft<16>(pair)));
        corners[2 * i + 1] = hn::ConvertTo(D(), hn::ShiftRight<16>(pair));
    }
    V distance;
    V3 gradient;
    bodyTrilinear(corners, cell.in, all(field.unit), distance, gradient);
    gradient = gradient * perCell;
    const V mixed = hn::Max(
        hn::Min((away - all(BodyField::kFineReach)) * all(1 / (BodyField::kFineEnd - BodyField::kFineReach)),
                one),
        zero);
    const V share = hn::IfThenElse(has, mixed, one);
    sample.distance = lerp(sample.distance, distance, share);
    sample.gradient = mulAdd(gradient - sample.gradient, share, sample.gradient);
    return sample;
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();
#endif
