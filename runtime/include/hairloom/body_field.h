// SPDX-License-Identifier: MIT
#pragma once
// A body as signed distances to its skin, baked in the space in which it rests and posed by its bones: what
// hair meets of a head that no sphere tells (docs/engine.md, "Bodies").

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hairloom/math.h"
#include "hairloom/memory.h"

namespace hairloom::runtime {

/// From the body at rest to the world: columns x, y, z and the place of the origin; metres.
struct BonePose {
    Float3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1}, origin{};

    friend constexpr bool operator==(const BonePose&, const BonePose&) = default;
    Float3 apply(Float3 p) const { return x * p.x + y * p.y + z * p.z + origin; }
};

/// Whether it flattens what is round to less than a thousandth, or is not finite.
bool isFlatPose(const BonePose& pose);
/// Of one that is not flat.
BonePose inverseOf(const BonePose& pose);

/// Distances at the corners of cells, interpolated trilinearly. Cells near the skin have a block of
/// kBlockCells³ smaller ones, of which some have a block of their own. Negative inside.
struct BodyField {
    static constexpr std::uint32_t kBlockCells = 4, kBlockCorners = kBlockCells + 1;
    static constexpr std::uint32_t kBlockValues = kBlockCorners * kBlockCorners * kBlockCorners;
    static constexpr std::size_t kFinerCells = kBlockCells * kBlockCells * kBlockCells;
    static constexpr std::uint16_t kNoBlock = 0xffff;
    static constexpr float kFineUnit = 1e-4f;    ///< metres of one step of a block's values: ± 12.7 mm
    static constexpr float kFineReach = 0.006f;  ///< metres from the skin within which blocks alone count
    static constexpr float kFineEnd = 0.010f;    ///< and from where on cells alone do

    /// Bones that move the skin at a corner.
    struct Skin {
        std::array<std::uint8_t, 4> bones{};    ///< of `bones`
        std::array<std::uint8_t, 4> weights{};  ///< of 255 in all; all 0: nothing moves it but the whole
        bool operator==(const Skin&) const = default;
    };

    Float3 low_ss{};                      ///< metres, the first corner
    float cell = 0;                       ///< metres, > 0
    std::array<std::uint32_t, 3> size{};  ///< cells along x, y, z; ≥ 1
    float unit = 0;                       ///< metres of one step of `distances`
    Vector<std::int16_t> distances;       ///< of each corner, x fastest
    Vector<std::uint16_t> skins;          ///< of each corner, index of `palette`
    Vector<Skin> palette;
    Vector<std::uint16_t> blocks;  ///< of each cell, x fastest
    Vector<std::int8_t> values;    ///< kBlockValues of each block, x fastest
    /// Of each block, its number among those that are refined where skin is folded or thin; kNoBlock for
    /// others. Empty: none is.
    Vector<std::uint16_t> refinements;
    /// Of each refined block and each of its cells, x fastest: a block for that cell; kNoBlock for none.
    Vector<std::uint16_t> finer;
    Vector<String> bones;  ///< names of at most 255; empty: the body moves as a whole
    /// A box at rest: outside of it a bone moves no skin and what is near it.
    struct Box {
        Float3 low{}, high{};
    };
    Vector<Box> boxes;  ///< of each bone

    /// Memory of its arrays, and what a file of it takes but for names.
    std::size_t bytes() const;
    /// Empty, or why it is none: sizes that do not match, indices out of range, numbers that are not finite.
    std::string problem() const;

    struct Sample {
        float distance;   ///< metres; infinite beyond the table
        Float3 gradient;  ///< of it; about of unit length
    };
    Sample at(Float3 point_ss) const;
    /// Metres that the skin is away from there at least; 0 where it may be anywhere near.
    float freeAround(Float3 point_ss) const;

    /// All of it, little-endian, as files keep it (docs/formats/body.md).
    std::vector<std::uint8_t> toBytes() const;
};

struct BodyFieldRead {
    std::optional<BodyField> field;
    std::string error;  ///< where there is none: what is wrong, and at which byte
};
/// Any bytes at all: counts are checked against what is there before anything is allocated.
BodyFieldRead bodyFieldFromBytes(std::span<const std::uint8_t> bytes);

/// A field in one pose. Owns nothing of the field, which outlives it.
class PosedBody {
  public:
    PosedBody() = default;
    /// `pose` has one entry per bone of the field, or one alone for a body that moves as a whole. A bone
    /// whose matrix flattens space (a scale of 0) carries no skin while it does; `flattened` counts them.
    PosedBody(const BodyField& field, std::span<const BonePose> pose) { take(field, pose); }
    /// The same again, in the memory that it has.
    void take(const BodyField& field, std::span<const BonePose> pose);

    struct Contact {
        float distance;    ///< metres in the world; infinite out of reach of the field
        Float3 normal_ws;  ///< unit length, out of the body; any where it is infinite
        Float3 point_ss;   ///< where on the body at rest that is
        /// The bone that alone moves the skin there, where the place was found by it.
        std::optional<std::size_t> bone = {};
    };
    Contact at(Float3 point_ws) const;
    /// Metres that the body is away from there at least; 0 where it may be anywhere near.
    float freeAround(Float3 point_ws) const;
    /// Where a place of the body at rest is in the world.
    Float3 place(Float3 point_ss) const;
    /// What takes places near one of the body at rest to the world.
    BonePose poseAt(Float3 point_ss) const;
    /// Of each entry of the field's palette; one alone where the body moves as a whole.
    std::span<const BonePose> palette() const { return palette_; }
    std::uint32_t flattened() const { return flattened_; }
    float cell() const { return field_->cell; }

  private:
    struct Map;
    Map mapAt(Float3 point_ss) const;
    Contact ofWhole(Float3 point_ws) const;
    bool isWhole() const { return palette_.size() == 1 && inverse_.size() == 1; }

    const BodyField* field_ = nullptr;
    Vector<BonePose> palette_;     ///< blended
    Vector<BonePose> inverse_;     ///< of bones, to the body at rest
    Vector<std::uint8_t> usable_;  ///< of bones
    std::uint32_t flattened_ = 0;
    float least_ = 1;  ///< least that a bone stretches what it carries
};

}  // namespace hairloom::runtime
