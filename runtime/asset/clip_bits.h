// SPDX-License-Identifier: MIT
#pragma once
// The frames of an asset's clip: strands' bits, and the places of points that come out of them.
// docs/formats/runtime.md says what each bit means.

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>

#include "hairloom/asset.h"
#include "hairloom/memory.h"

namespace hairloom::runtime {

/// A coordinate of each point behind its root, in cells: x, y, z of one point after another.
using ClipCells = std::span<std::int32_t>;
using ConstClipCells = std::span<const std::int32_t>;

/// Of all strands, strand after strand, without their roots, in cells of 1 / 2^gridBits metres: what frames
/// that nothing comes before are predicted from.
Vector<std::int32_t> clipRest(const Asset::Strands& rest, std::uint32_t gridBits);

/// A strand's bits of a block, from the front to the back. Behind their end there are zeros, and isGood() is
/// false.
class ClipBits {
  public:
    explicit ClipBits(std::span<const std::byte> bytes, std::uint64_t at = 0) : bytes_(bytes), at_(at) {}
    /// Up to 32 bits, the lowest first.
    std::uint32_t take(std::uint32_t count) {
        const std::uint64_t ahead = look();
        at_ += count;
        return static_cast<std::uint32_t>(ahead & ((std::uint64_t{1} << count) - 1));
    }
    /// A number by its quotient in ones, a zero, and `low` bits, at most 14 of them; by kMostClipOnes ones
    /// and 32 bits where it is large.
    std::uint32_t takeNumber(std::uint32_t low) {
        const std::uint64_t ahead = look();
        const auto ones = static_cast<std::uint32_t>(std::countr_one(ahead));
        if (ones < asset::kMostClipOnes) {
            at_ += ones + 1 + low;
            const std::uint64_t rest = ahead >> (ones + 1) & ((std::uint64_t{1} << low) - 1);
            return (ones << low) | static_cast<std::uint32_t>(rest);
        }
        at_ += asset::kMostClipOnes;
        return take(32);
    }
    /// Of the bits that were taken.
    std::uint64_t at() const { return at_; }
    /// Whether no more bits were taken than there are.
    bool isGood() const { return at_ <= 8 * std::uint64_t{bytes_.size()}; }
    /// Whether no more than the rest of a byte is left, and that is zero.
    bool isAtEnd() const;

  private:
    /// At least 57 bits from the next one on.
    std::uint64_t look() const {
        static_assert(asset::kMostClipOnes + 1 + asset::kMostClipLowBits <= 57);
        const std::uint64_t first = at_ / 8;
        std::uint64_t word = 0;
        if (std::endian::native == std::endian::little && first + 8 <= bytes_.size()) {
            std::memcpy(&word, bytes_.data() + first, 8);
        } else {
            for (std::uint64_t i = 0; i < 8 && first + i < bytes_.size(); ++i)
                word |= std::to_integer<std::uint64_t>(bytes_[static_cast<std::size_t>(first + i)])
                        << (8 * i);
        }
        return word >> (at_ % 8);
    }

    std::span<const std::byte> bytes_;
    std::uint64_t at_;
};

/// Frame `number` of a block, counted from 0, into `cells`, which may be `beforeLast`. False where the bits
/// are no frame: then `cells` is of no use. `last` and `beforeLast` are the frames before, where the block
/// has them.
bool readClipFrame(ClipBits& bits, std::uint32_t number, ConstClipCells rest, ConstClipCells last,
                   ConstClipCells beforeLast, ClipCells cells);

/// The bits of a strand in a block of the clip. Empty where their places are not in the file.
std::span<const std::byte> clipStrandBytes(const Asset& asset, std::size_t block, std::size_t strand);

inline std::uint32_t clipBlocks(const asset::Clip& clip) {
    return (clip.frames + clip.framesPerBlock - 1) / clip.framesPerBlock;
}

}  // namespace hairloom::runtime
