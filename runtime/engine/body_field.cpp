// SPDX-License-Identifier: MIT
#include "hairloom/body_field.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>

#include "engine/body_free.h"
#include "engine/body_table.h"
#include "hwy/base.h"

namespace hairloom::runtime {
namespace {

constexpr float kInfinite = std::numeric_limits<float>::infinity();
constexpr std::size_t kCellCorners = 8;
/// Of a distance, per metre: below it there is no way out that is the nearest.
constexpr float kFlatSlope = 1e-3f;

/// Places within a cell, each in [0, 1], and what each of its corners counts there: 000, 100, 010, 110, 001 …
struct Trilinear {
    float x, y, z;

    std::array<float, kCellCorners> weights() const {
        const float a = 1 - x, b = 1 - y, c = 1 - z;
        return {a * b * c, x * b * c, a * y * c, x * y * c, a * b * z, x * b * z, a * y * z, x * y * z};
    }
    /// The gradient is in steps of the cell.
    BodyField::Sample sample(const std::array<float, kCellCorners>& v) const {
        const auto mix = [](float a, float b, float t) { return a + t * (b - a); };
        const float x00 = mix(v[0], v[1], x), x10 = mix(v[2], v[3], x), x01 = mix(v[4], v[5], x),
                    x11 = mix(v[6], v[7], x);
        const float y0 = mix(x00, x10, y), y1 = mix(x01, x11, y);
        const Float3 gradient{
            mix(mix(v[1] - v[0], v[3] - v[2], y), mix(v[5] - v[4], v[7] - v[6], y), z),
            mix(x10 - x00, x11 - x01, z),
            y1 - y0,
        };
        return {mix(y0, y1, z), gradient};
    }
};

/// A cell of a table, and where in it a point is.
struct CellPlace {
    std::uint32_t x, y, z;
    Trilinear in;
};

/// `cells` from the first corner of the table; within its size.
HWY_INLINE CellPlace placeAt(Float3 cells, std::uint32_t sizeX, std::uint32_t sizeY, std::uint32_t sizeZ) {
    const auto along = [](float at, std::uint32_t size) {
        return std::min(static_cast<std::uint32_t>(std::max(at, 0.0f)), size - 1);
    };
    const std::uint32_t x = along(cells.x, sizeX), y = along(cells.y, sizeY), z = along(cells.z, sizeZ);
    return {
        x,
        y,
        z,
        {cells.x - static_cast<float>(x), cells.y - static_cast<float>(y), cells.z - static_cast<float>(z)}};
}

/// Of the corners of a cell, whose first is `first`, in a table with rows of `row` and layers of `layer`.
template <class T>
std::array<T, kCellCorners> cornersOf(const T* first, std::size_t row, std::size_t layer) {
    return {first[0],     first[1],         first[row],         first[row + 1],
            first[layer], first[layer + 1], first[layer + row], first[layer + row + 1]};
}

std::array<float, kCellCorners> scaled(const auto& values, float unit) {
    std::array<float, kCellCorners> result;
    for (std::size_t i = 0; i < kCellCorners; ++i) result[i] = unit * static_cast<float>(values[i]);
    return result;
}

HWY_INLINE bool isInside(const BodyField& field, Float3 cells) {
    const auto within = [](float at, std::uint32_t size) {
        return at >= 0 && at <= static_cast<float>(size);
    };
    return within(cells.x, field.size[0]) && within(cells.y, field.size[1]) && within(cells.z, field.size[2]);
}

std::size_t cornerIndex(const BodyField& field, const CellPlace& place) {
    return (std::size_t{place.z} * (field.size[1] + 1) + place.y) * (field.size[0] + 1) + place.x;
}

/// Of the cell that a place is in, or the nearest to it.
std::size_t cornerOfCell(const BodyField& field, Float3 point_ss) {
    const Float3 cells = (point_ss - field.low_ss) * (1 / field.cell);
    return cornerIndex(field, placeAt(cells, field.size[0], field.size[1], field.size[2]));
}

BonePose blendOf(const BonePose& a, const BonePose& b, float weight) {
    return {a.x + b.x * weight, a.y + b.y * weight, a.z + b.z * weight, a.origin + b.origin * weight};
}
constexpr BonePose kNothing{{}, {}, {}, {}};

/// Of a gradient at rest, by what takes places from the world to there.
Float3 gradientBack(const BonePose& inverse, Float3 g) {
    return {dot(inverse.x, g), dot(inverse.y, g), dot(inverse.z, g)};
}

float volumeOf(const BonePose& pose) {
    return dot(pose.x, cross(pose.y, pose.z));
}

/// Of the linear part: rows, so that (dot(x, v), dot(y, v), dot(z, v)) undoes it.
struct Undone {
    Float3 x, y, z;

    explicit Undone(const BonePose& pose) {
        const float inverse = 1 / volumeOf(pose);
        x = cross(pose.y, pose.z) * inverse;
        y = cross(pose.z, pose.x) * inverse;
        z = cross(pose.x, pose.y) * inverse;
    }
    Float3 apply(Float3 v) const { return {dot(x, v), dot(y, v), dot(z, v)}; }
    /// Of a gradient, to the world.
    Float3 transposed(Float3 g) const { return x * g.x + y * g.y + z * g.z; }
};

HWY_INLINE bool isIn(const BodyField::Box& box, Float3 p) {
    return p.x >= box.low.x && p.y >= box.low.y && p.z >= box.low.z && p.x <= box.high.x &&
           p.y <= box.high.y && p.z <= box.high.z;
}

HWY_INLINE float freeIn(const BodyField& field, Float3 point_ss) {
    const Float3 cells = (point_ss - field.low_ss) * (1 / field.cell);
    // Beyond the table there is no skin that hair could meet.
    if (!isInside(field, cells)) {
        const Float3 size{static_cast<float>(field.size[0]), static_cast<float>(field.size[1]),
                          static_cast<float>(field.size[2])};
        return distanceTo({field.low_ss, field.low_ss + size * field.cell}, point_ss);
    }
    const Corner corner = nearestCorner(field, cells);
    const float there = static_cast<float>(field.distances[corner.index]) - 0.5f;  // as it is rounded
    return std::max(field.unit * there - 1.0001f * field.cell * corner.away, 0.0f);
}

/// Metres at rest that what a bone carries is away at least, `most` where that is more. Skin between two
/// bones may be closer than it was at rest, but hardly by half.
HWY_INLINE float freeOfBone(const BodyField& field, std::size_t bone, Float3 point_ss, float most) {
    const float beside = field.boxes.empty() ? 0.0f : distanceTo(field.boxes[bone], point_ss);
    return beside >= most ? most : std::min(std::max(beside, 0.5f * freeIn(field, point_ss)), most);
}

/// Where skin takes a place in the world from, by repeated substitution from `rest` on. `mapAt` tells what
/// takes places near one at rest to the world. Skin between two bones turns along one line, on which two
/// steps tell where all others lead (Anderson's mixing of two). False where it does not settle.
template <class Map, class MapAt>
bool follow(Float3 point_ws, Float3& rest, Map& map, MapAt&& mapAt) {
    constexpr int kRounds = 12;
    constexpr float kSettled = 1e-5f, kLost = 2e-3f;  // metres
    constexpr float kMostMixed = 2;
    Float3 stepBefore{}, nextBefore{};
    float off = kInfinite;
    for (int round = 0; round < kRounds; ++round) {
        map = mapAt(rest);
        const Float3 next =
            map.inverse ? map.inverse->apply(point_ws) : Undone(map.pose).apply(point_ws - map.pose.origin);
        const Float3 step = next - rest, turned = step - stepBefore;
        off = length(step);
        rest = next;
        if (!(off > kSettled)) break;
        const float share = dot(step, turned) / dot(turned, turned);
        if (round > 0 && std::abs(share) <= kMostMixed) rest = next - (next - nextBefore) * share;
        stepBefore = step;
        nextBefore = next;
    }
    return off < kLost && (map.inverse || !isFlatPose(map.pose));
}

}  // namespace

bool isFlatPose(const BonePose& pose) {
    const float size = length(pose.x) * length(pose.y) * length(pose.z);
    const float volume = volumeOf(pose);
    return !(std::abs(volume) > 1e-3f * size) || !(size > 1e-9f) || !std::isfinite(size) ||
           !isFinite(pose.origin);
}

BonePose inverseOf(const BonePose& pose) {
    const Undone u(pose);
    BonePose inverse{{u.x.x, u.y.x, u.z.x}, {u.x.y, u.y.y, u.z.y}, {u.x.z, u.y.z, u.z.z}, {}};
    inverse.origin = u.apply(pose.origin) * -1.0f;
    return inverse;
}

std::size_t BodyField::bytes() const {
    return distances.size() * sizeof(distances[0]) + skins.size() * sizeof(skins[0]) +
           palette.size() * sizeof(palette[0]) + blocks.size() * sizeof(blocks[0]) +
           values.size() * sizeof(values[0]) + boxes.size() * sizeof(boxes[0]) +
           (refinements.size() + finer.size()) * sizeof(finer[0]);
}

std::string BodyField::problem() const {
    constexpr std::uint64_t kMost = 1u << 28;
    if (!(cell > 0) || !std::isfinite(cell) || !(unit > 0) || !std::isfinite(unit) || !isFinite(low_ss))
        return "a body's cells have no size";
    std::uint64_t cells = 1, corners = 1;
    for (const std::uint32_t along : size) {
        if (along < 1 || along > kMost) return "a body without cells";
        cells *= along;
        corners *= std::uint64_t{along} + 1;
        if (corners > kMost) return "a body of too many cells";
    }
    if (distances.size() != corners || skins.size() != corners || blocks.size() != cells)
        return "a body's tables are not as large as its size says";
    if (values.size() % kBlockValues != 0 || values.size() / kBlockValues >= kNoBlock)
        return "a body's blocks are not whole";
    const std::size_t blockCount = values.size() / kBlockValues;
    for (const std::uint16_t block : blocks) {
        if (block != kNoBlock && block >= blockCount) return "a body names a block that it does not have";
    }
    if (!refinements.empty() && refinements.size() != blockCount)
        return "a body's refined blocks do not match its blocks";
    if (finer.size() % kFinerCells != 0) return "a body's refined blocks are not whole";
    for (const std::uint16_t refined : refinements) {
        if (refined != kNoBlock && refined >= finer.size() / kFinerCells)
            return "a body names a refined block that it does not have";
    }
    for (const std::uint16_t block : finer) {
        if (block != kNoBlock && block >= blockCount) return "a body names a block that it does not have";
    }
    for (const std::uint16_t skin : skins) {
        if (skin >= palette.size()) return "a body names skin that it does not have";
    }
    if (bones.size() > 255 || boxes.size() != bones.size()) return "a body's bones do not match";
    for (const Skin& skin : palette) {
        for (std::size_t i = 0; i < skin.bones.size(); ++i) {
            if (skin.weights[i] > 0 && skin.bones[i] >= bones.size())
                return "a body names a bone that it does not have";
        }
    }
    for (const Box& box : boxes) {
        if (!isFinite(box.low) || !isFinite(box.high)) return "a body's bone reaches nowhere";
    }
    return {};
}

BodyField::Sample BodyField::at(Float3 point_ss) const {
    const float perCell = 1 / cell;
    const Float3 cells = (point_ss - low_ss) * perCell;
    if (!isInside(*this, cells)) return {kInfinite, {0, 1, 0}};
    const CellPlace place = placeAt(cells, size[0], size[1], size[2]);
    const auto coarseSample = [&] {
        const std::size_t row = size[0] + 1, layer = row * (size[1] + 1);
        const std::int16_t* const first = distances.data() + cornerIndex(*this, place);
        Sample coarse = place.in.sample(scaled(cornersOf(first, row, layer), unit));
        coarse.gradient = coarse.gradient * perCell;
        return coarse;
    };
    const std::uint16_t block = blocks[(std::size_t{place.z} * size[1] + place.y) * size[0] + place.x];
    if (block == kNoBlock) return coarseSample();
    constexpr auto kFine = static_cast<float>(kBlockCells);
    const auto placeIn = [](const Trilinear& cellPlace) {
        return placeAt({cellPlace.x * kFine, cellPlace.y * kFine, cellPlace.z * kFine}, kBlockCells,
                       kBlockCells, kBlockCells);
    };
    CellPlace in = placeIn(place.in);
    std::size_t own = block;
    float steps = perCell * kFine;
    if (const std::uint16_t refined = refinements.empty() ? kNoBlock : refinements[block];
        refined != kNoBlock) {
        const std::size_t inBlock = (std::size_t{in.z} * kBlockCells + in.y) * kBlockCells + in.x;
        if (const std::uint16_t finest = finer[refined * kFinerCells + inBlock]; finest != kNoBlock) {
            own = finest;
            in = placeIn(in.in);
            steps *= kFine;
        }
    }
    const std::int8_t* const first = values.data() + own * kBlockValues +
                                     (std::size_t{in.z} * kBlockCorners + in.y) * kBlockCorners + in.x;
    Sample fine =
        in.in.sample(scaled(cornersOf(first, kBlockCorners, kBlockCorners * kBlockCorners), kFineUnit));
    fine.gradient = fine.gradient * steps;
    const float away = std::abs(fine.distance);
    if (away <= kFineReach) return fine;
    const Sample coarse = coarseSample();
    const float share = std::min((away - kFineReach) / (kFineEnd - kFineReach), 1.0f);
    return {fine.distance + share * (coarse.distance - fine.distance),
            fine.gradient + (coarse.gradient - fine.gradient) * share};
}

float BodyField::freeAround(Float3 point_ss) const {
    return freeIn(*this, point_ss);
}

/// What takes places near one at rest to the world.
struct PosedBody::Map {
    BonePose pose;
    const BonePose* inverse;  ///< where it is known; it is not flat then
};

void PosedBody::take(const BodyField& field, std::span<const BonePose> pose) {
    field_ = &field;
    flattened_ = 0;
    least_ = kInfinite;
    usable_.clear();
    inverse_.clear();
    palette_.clear();
    // Bones that all move alike move a body as a whole, which is looked up for a third of the price.
    const bool alike = std::all_of(pose.begin(), pose.end(), [&](const BonePose& b) { return b == pose[0]; });
    const std::size_t bones = alike ? 1 : std::max<std::size_t>(field.bones.size(), 1);
    for (std::size_t b = 0; b < bones; ++b) {
        const BonePose& own = pose[std::min(b, pose.size() - 1)];
        const bool flat = isFlatPose(own);
        usable_.push_back(flat ? 0 : 1);
        flattened_ += flat ? 1u : 0u;
        inverse_.push_back(flat ? BonePose{} : inverseOf(own));
        if (!flat) least_ = std::min({least_, length(own.x), length(own.y), length(own.z)});
    }
    if (!std::isfinite(least_)) least_ = 1;
    if (alike) {
        flattened_ *= static_cast<std::uint32_t>(std::max<std::size_t>(field.bones.size(), 1));
        palette_.push_back(flattened_ > 0 && !field.bones.empty() ? BonePose{} : pose[0]);
        return;
    }
    for (const BodyField::Skin& skin : field.palette) {
        float sum = 0;
        BonePose blended = kNothing;
        for (std::size_t i = 0; i < skin.bones.size(); ++i) {
            const std::size_t bone = std::min<std::size_t>(skin.bones[i], pose.size() - 1);
            if (skin.weights[i] == 0 || usable_[std::min<std::size_t>(skin.bones[i], bones - 1)] == 0)
                continue;
            const auto weight = static_cast<float>(skin.weights[i]);
            blended = blendOf(blended, pose[bone], weight);
            sum += weight;
        }
        palette_.push_back(sum > 0 ? blendOf(kNothing, blended, 1 / sum) : BonePose{});
        // Behind those of bones. What is flat has the inverse that takes nothing anywhere.
        inverse_.push_back(isFlatPose(palette_.back()) ? kNothing : inverseOf(palette_.back()));
    }
}

PosedBody::Map PosedBody::mapAt(Float3 point_ss) const {
    if (isWhole()) return {palette_[0], inverse_.data()};
    const BodyField& field = *field_;
    const Float3 cells = (point_ss - field.low_ss) * (1 / field.cell);
    const CellPlace place = placeAt(cells, field.size[0], field.size[1], field.size[2]);
    const std::size_t row = field.size[0] + 1, layer = row * (field.size[1] + 1);
    const auto skins = cornersOf(field.skins.data() + cornerIndex(field, place), row, layer);
    bool same = true;
    for (const std::uint16_t skin : skins) same = same && skin == skins[0];
    if (same) {
        const BonePose& inverse = inverse_[usable_.size() + skins[0]];
        return {palette_[skins[0]], inverse == kNothing ? nullptr : &inverse};
    }
    const auto weights = place.in.weights();
    // As rows of numbers, four of which are reckoned at once.
    constexpr std::size_t kNumbers = sizeof(BonePose) / sizeof(float);
    float sum[kNumbers] = {};
    for (std::size_t i = 0; i < kCellCorners; ++i) {
        const float* const numbers = &palette_[skins[i]].x.x;
        for (std::size_t k = 0; k < kNumbers; ++k) sum[k] += weights[i] * numbers[k];
    }
    Map map{kNothing, nullptr};
    std::memcpy(&map.pose, sum, sizeof(sum));
    return map;
}

PosedBody::Contact PosedBody::ofWhole(Float3 point_ws) const {
    const Contact nothing{kInfinite, {0, 1, 0}, {}};
    if (usable_[0] == 0) return nothing;
    const Float3 rest = inverse_[0].apply(point_ws);
    const BodyField::Sample sample = field_->at(rest);
    if (!std::isfinite(sample.distance)) return nothing;
    const Float3 gradient = gradientBack(inverse_[0], sample.gradient);
    const float slope = length(gradient);
    if (!(slope > kFlatSlope)) return nothing;
    return {sample.distance * (length(sample.gradient) / slope), gradient * (1 / slope), rest, 0};
}

float PosedBody::freeAround(Float3 point_ws) const {
    float least = kInfinite;
    for (std::size_t b = 0; b < usable_.size() && least > 0; ++b) {
        if (usable_[b] == 0) continue;
        const Float3 rest = inverse_[b].apply(point_ws);
        if (isWhole()) return least_ * freeIn(*field_, rest);
        least = least_ * freeOfBone(*field_, b, rest, least / least_);
    }
    return least;
}

PosedBody::Contact PosedBody::at(Float3 point_ws) const {
    if (isWhole()) return ofWhole(point_ws);
    constexpr unsigned kMuch = 64;  // of 255
    const BodyField& field = *field_;
    Contact nearest{kInfinite, {0, 1, 0}, {}};
    std::array<Float3, 4> found;
    std::size_t foundCount = 0;
    // What a bone moves much of is found from where the bone has it; what another bone has been found to
    // share, or to be beside, is the same place. Where no bone has anything, all are tried.
    const auto isFound = [&](std::size_t bone, Float3 rest) {
        return std::any_of(found.begin(), found.begin() + foundCount, [&](Float3 place) {
            const unsigned share = shareOf(field, bone, place);
            return share >= kMuch || (share > 0 && length(rest - place) < field.cell);
        });
    };
    for (const bool all : {false, true}) {
        if (all && foundCount > 0) break;
        for (std::size_t b = 0; b < usable_.size(); ++b) {
            if (usable_[b] == 0) continue;
            Float3 rest = inverse_[b].apply(point_ws);
            if (!field.boxes.empty() && !isIn(field.boxes[b], rest)) continue;
            if (!all && (shareOf(field, b, rest) == 0 || isFound(b, rest))) continue;
            // What one bone has shown is nearer than anything that another carries.
            if (std::isfinite(nearest.distance) &&
                least_ * freeOfBone(field, b, rest, kInfinite) > nearest.distance)
                continue;
            Map map{};
            if (!follow(point_ws, rest, map, [&](Float3 at) { return mapAt(at); })) continue;
            if (foundCount < found.size()) found[foundCount++] = rest;
            const BodyField::Sample sample = field.at(rest);
            if (!std::isfinite(sample.distance)) continue;
            const Float3 gradient = map.inverse ? gradientBack(*map.inverse, sample.gradient)
                                                : Undone(map.pose).transposed(sample.gradient);
            const float slope = length(gradient);
            // On the ridge between two sides the slope vanishes: there is no way out that is the nearest.
            if (!(slope > kFlatSlope)) continue;
            // Bones that stretch the skin stretch what is before it.
            const float distance = sample.distance * (length(sample.gradient) / slope);
            if (!(distance < nearest.distance)) continue;
            nearest = {distance, gradient * (1 / slope), rest, {}};
            if (map.inverse && boneOfCell(field, cornerOfCell(field, rest)) == static_cast<std::int32_t>(b))
                nearest.bone = b;
        }
    }
    return nearest;
}

BonePose PosedBody::poseAt(Float3 point_ss) const {
    return mapAt(point_ss).pose;
}

Float3 PosedBody::place(Float3 point_ss) const {
    return poseAt(point_ss).apply(point_ss);
}

}  // namespace hairloom::runtime
