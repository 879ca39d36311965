// SPDX-License-Identifier: MIT
#pragma once
// A body's distances as vectors of lanes gather them.

#include <cstddef>
#include <cstdint>

#include "hairloom/body_field.h"
#include "hairloom/memory.h"

namespace hairloom::runtime {

/// The same numbers as a field's, packed into aligned words so that two reads tell all corners of a cell.
struct BodyTable {
    static constexpr std::int32_t kMixed = 0xff;  ///< of a cell whose skin does not go with one bone alone
    static constexpr std::int32_t kRefined = 1 << 24;
    static constexpr std::int32_t kRow = BodyField::kBlockCells, kLayer = kRow * kRow;
    static constexpr std::int32_t kBlockQuads = kLayer * BodyField::kBlockCorners;

    BodyTable() = default;
    explicit BodyTable(const BodyField& field);

    /// Of each cell: its block, BodyField::kNoBlock for none; from bit 16 the bone; kRefined.
    Vector<std::int32_t> cells;
    /// Of each block and each of its cells and layers, four bytes: the distances at (0, 0), (1, 0), (0, 1)
    /// and (1, 1) of x and y.
    Vector<std::int32_t> quads;
    /// Of each corner, two halves: the distances there and at the next one along x.
    Vector<std::int32_t> pairs;
    Vector<std::int32_t> refinements;  ///< of each block, BodyField::refinements
    Vector<std::int32_t> finer;        ///< BodyField::finer
    Vector<std::int32_t> skins;        ///< of each corner, BodyField::skins
    /// Of each entry of the palette, four bytes: its bones and their weights.
    Vector<std::int32_t> skinBones, skinWeights;

    /// Of the table of a field, which is not made.
    static std::size_t bytesFor(const BodyField& field);
    std::size_t bytes() const {
        return (cells.size() + quads.size() + pairs.size() + refinements.size() + finer.size() +
                skins.size() + skinBones.size() + skinWeights.size()) *
               sizeof(std::int32_t);
    }
};

/// The one bone that skin hangs on in a whole cell, of which `corner` is the first; BodyTable::kMixed where
/// there are more.
std::int32_t boneOfCell(const BodyField& field, std::size_t corner);

}  // namespace hairloom::runtime
