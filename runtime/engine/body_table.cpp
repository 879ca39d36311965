// SPDX-License-Identifier: MIT
#include "engine/body_table.h"

#include <algorithm>

namespace hairloom::runtime {

std::int32_t boneOfCell(const BodyField& field, std::size_t corner) {
    if (field.bones.empty()) return 0;
    const std::size_t row = field.size[0] + 1, layer = row * (field.size[1] + 1);
    const std::uint16_t first = field.skins[corner];
    for (const std::size_t step :
         {std::size_t{1}, row, row + 1, layer, layer + 1, layer + row, layer + row + 1})
        if (field.skins[corner + step] != first) return BodyTable::kMixed;
    const BodyField::Skin& skin = field.palette[first];
    constexpr std::uint8_t kAll = 255;
    const auto whole = std::find(skin.weights.begin(), skin.weights.end(), kAll);
    if (whole == skin.weights.end()) return BodyTable::kMixed;
    return skin.bones[static_cast<std::size_t>(whole - skin.weights.begin())];
}

BodyTable::BodyTable(const BodyField& field) {
    constexpr std::uint32_t kCells = BodyField::kBlockCells, kCorners = BodyField::kBlockCorners;
    const auto word = [](std::uint32_t bits) { return static_cast<std::int32_t>(bits); };
    const std::uint32_t nx = field.size[0], ny = field.size[1], nz = field.size[2];
    cells.reserve(field.blocks.size());
    std::size_t cell = 0;
    for (std::uint32_t z = 0; z < nz; ++z)
        for (std::uint32_t y = 0; y < ny; ++y)
            for (std::uint32_t x = 0; x < nx; ++x, ++cell) {
                const std::size_t corner = (std::size_t{z} * (ny + 1) + y) * (nx + 1) + x;
                const std::uint16_t block = field.blocks[cell];
                const bool isRefined = block != BodyField::kNoBlock && !field.refinements.empty() &&
                                       field.refinements[block] != BodyField::kNoBlock;
                cells.push_back(word(block) | boneOfCell(field, corner) << 16 | (isRefined ? kRefined : 0));
            }
    const auto byte = [](std::int8_t value, unsigned shift) {
        return std::uint32_t{static_cast<std::uint8_t>(value)} << shift;
    };
    const std::size_t blocks = field.values.size() / BodyField::kBlockValues;
    quads.reserve(std::max<std::size_t>(blocks, 1) * kBlockQuads);
    for (std::size_t b = 0; b < blocks; ++b)
        for (std::uint32_t z = 0; z < kCorners; ++z)
            for (std::uint32_t y = 0; y < kCells; ++y)
                for (std::uint32_t x = 0; x < kCells; ++x) {
                    const std::int8_t* const v = field.values.data() + b * BodyField::kBlockValues +
                                                 (std::size_t{z} * kCorners + y) * kCorners + x;
                    quads.push_back(word(byte(v[0], 0) | byte(v[1], 8) | byte(v[kCorners], 16) |
                                         byte(v[kCorners + 1], 24)));
                }
    // What lanes without a block read.
    quads.resize(std::max<std::size_t>(quads.size(), kBlockQuads), 0);
    pairs.reserve(field.distances.size());
    for (std::size_t i = 0; i < field.distances.size(); ++i) {
        const auto here = static_cast<std::uint16_t>(field.distances[i]);
        const auto next = static_cast<std::uint16_t>(i + 1 < field.distances.size() ? field.distances[i + 1]
                                                                                    : std::int16_t{0});
        pairs.push_back(word(std::uint32_t{here} | std::uint32_t{next} << 16));
    }
    refinements.assign(field.refinements.begin(), field.refinements.end());
    finer.assign(field.finer.begin(), field.finer.end());
    skins.assign(field.skins.begin(), field.skins.end());
    const auto four = [&](const std::array<std::uint8_t, 4>& v) {
        return word(std::uint32_t{v[0]} | std::uint32_t{v[1]} << 8 | std::uint32_t{v[2]} << 16 |
                    std::uint32_t{v[3]} << 24);
    };
    for (const BodyField::Skin& skin : field.palette) {
        skinBones.push_back(four(skin.bones));
        skinWeights.push_back(four(skin.weights));
    }
}

std::size_t BodyTable::bytesFor(const BodyField& field) {
    const std::size_t blocks = field.values.size() / BodyField::kBlockValues;
    return (field.blocks.size() + std::max<std::size_t>(blocks, 1) * kBlockQuads + field.distances.size() +
            field.refinements.size() + field.finer.size() + field.skins.size() + 2 * field.palette.size()) *
           sizeof(std::int32_t);
}

}  // namespace hairloom::runtime
