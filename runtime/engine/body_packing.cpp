// SPDX-License-Identifier: MIT
// Distances change evenly from place to place, so each is told by how far it is off from what the places
// before it lead to expect (Ibarria et al. 2003, "Out-of-core compression and decompression of large
// n-dimensional scalar fields"). What is left is small, and written in Rice's codes (Rice and Plaunt 1971).

#include "engine/body_packing.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <type_traits>
#include <utility>

namespace hairloom::runtime {
namespace {

/// Numbers that share a code: 4 bits say which, the last that all are 0.
constexpr std::size_t kRunLength = BodyField::kBlockValues;
constexpr std::uint32_t kRunBits = 4, kAllZero = 15;
/// So many ones, and the number itself follows.
constexpr std::uint32_t kMostOnes = 20, kWholeBits = 20;

std::uint32_t unsignedOf(std::int32_t value) {
    return (static_cast<std::uint32_t>(value) << 1u) ^ (value < 0 ? ~0u : 0u);
}

std::int32_t signedOf(std::uint32_t value) {
    return static_cast<std::int32_t>((value >> 1u) ^ (0u - (value & 1u)));
}

class PackedWriter {
  public:
    void put(std::int32_t value) {
        run_[count_++] = unsignedOf(value);
        if (count_ == kRunLength) endRun();
    }
    /// Begins a run with what comes next.
    void endRun() {
        if (count_ == 0) return;
        const std::uint32_t code = bestCode();
        bits(code, kRunBits);
        for (std::size_t i = 0; i < count_ && code != kAllZero; ++i) {
            const std::uint32_t ones = run_[i] >> code;
            if (ones < kMostOnes) {
                bits((1u << ones) - 1, ones + 1);
                bits(run_[i] & ((1u << code) - 1), code);
            } else {
                bits((1u << kMostOnes) - 1, kMostOnes);
                bits(run_[i], kWholeBits);
            }
        }
        count_ = 0;
    }
    std::vector<std::uint8_t> finish() {
        endRun();
        if (filled_ > 0) bytes_.push_back(static_cast<std::uint8_t>(held_));
        return std::move(bytes_);
    }

  private:
    std::uint32_t bestCode() const {
        const auto run = std::span(run_).first(count_);
        if (std::all_of(run.begin(), run.end(), [](std::uint32_t v) { return v == 0; })) return kAllZero;
        std::uint64_t fewest = ~0ull;
        std::uint32_t best = 0;
        for (std::uint32_t code = 0; code < kAllZero; ++code) {
            std::uint64_t sum = 0;
            for (std::size_t i = 0; i < count_; ++i) {
                const std::uint32_t ones = run_[i] >> code;
                sum += ones < kMostOnes ? ones + 1 + code : kMostOnes + kWholeBits;
            }
            if (sum < fewest) fewest = sum, best = code;
        }
        return best;
    }
    void bits(std::uint32_t value, std::uint32_t count) {
        held_ |= std::uint64_t{value} << filled_;
        for (filled_ += count; filled_ >= 8; filled_ -= 8, held_ >>= 8u)
            bytes_.push_back(static_cast<std::uint8_t>(held_));
    }

    std::vector<std::uint8_t> bytes_;
    std::array<std::uint32_t, kRunLength> run_{};
    std::size_t count_ = 0;
    std::uint64_t held_ = 0;
    std::uint32_t filled_ = 0;
};

/// Gives zeros after the end, and says so.
class PackedReader {
  public:
    explicit PackedReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
    std::int32_t next() {
        if (left_ == 0) beginRun();
        --left_;
        if (code_ == kAllZero) return 0;
        std::uint32_t ones = 0;
        while (ones < kMostOnes && bits(1) != 0) ++ones;
        return signedOf(ones < kMostOnes ? (ones << code_ | bits(code_)) : bits(kWholeBits));
    }
    void endRun() { left_ = 0; }
    /// All bytes are used, and no more than there are.
    bool endsHere() const { return !isShort_ && at_ == bytes_.size(); }

  private:
    void beginRun() {
        code_ = bits(kRunBits);
        left_ = kRunLength;
    }
    std::uint32_t bits(std::uint32_t count) {
        while (filled_ < count) {
            isShort_ = isShort_ || at_ == bytes_.size();
            if (!isShort_) held_ |= std::uint64_t{bytes_[at_++]} << filled_;
            filled_ += 8;
        }
        const auto value = static_cast<std::uint32_t>(held_ & ((std::uint64_t{1} << count) - 1));
        held_ >>= count;
        filled_ -= count;
        return value;
    }

    std::span<const std::uint8_t> bytes_;
    std::size_t at_ = 0, left_ = 0;
    std::uint64_t held_ = 0;
    std::uint32_t filled_ = 0, code_ = 0;
    bool isShort_ = false;
};

/// Calls `each` with each number of a grid, x fastest, and what the ones before it lead to expect.
template <class T, class Each>
void alongGrid(T* values, std::array<std::size_t, 3> size, const Each& each) {
    const std::size_t row = size[0], layer = size[0] * size[1];
    std::size_t i = 0;
    for (std::size_t z = 0; z < size[2]; ++z) {
        for (std::size_t y = 0; y < size[1]; ++y) {
            for (std::size_t x = 0; x < size[0]; ++x, ++i) {
                const auto before = [&](bool alongX, bool alongY, bool alongZ) -> std::int32_t {
                    if ((alongX && x == 0) || (alongY && y == 0) || (alongZ && z == 0)) return 0;
                    return values[i - (alongX ? 1 : 0) - (alongY ? row : 0) - (alongZ ? layer : 0)];
                };
                each(values[i], before(true, false, false) + before(false, true, false) +
                                    before(false, false, true) - before(true, true, false) -
                                    before(true, false, true) - before(false, true, true) +
                                    before(true, true, true));
            }
        }
    }
}

constexpr std::array<std::size_t, 3> kBlockSize{BodyField::kBlockCorners, BodyField::kBlockCorners,
                                                BodyField::kBlockCorners};

std::array<std::size_t, 3> cornersOf(const BodyField& field) {
    return {std::size_t{field.size[0]} + 1, std::size_t{field.size[1]} + 1, std::size_t{field.size[2]} + 1};
}

/// Calls `each` with each number of all blocks and what is expected of it, cell after cell, then those of
/// blocks that no cell has. The places that a block shares with blocks before it come first, and say the
/// same; `endRun` follows them and the others.
template <class T, class Each, class EndRun>
void alongBlocks(const BodyField& field, T* values, std::size_t count, const Each& each,
                 const EndRun& endRun) {
    constexpr std::size_t kAlong = BodyField::kBlockCorners, kLast = kAlong - 1;
    using Lower = std::array<const T*, 3>;
    const auto numbersOf = [&](std::size_t block, const Lower& lower) {
        T* const own = values + block * BodyField::kBlockValues;
        for (const bool wantsShared : {true, false}) {
            alongGrid(own, kBlockSize, [&](T& value, std::int32_t expected) {
                const auto i = static_cast<std::size_t>(&value - own);
                const bool first[] = {i % kAlong == 0, i / kAlong % kAlong == 0, i / (kAlong * kAlong) == 0};
                const std::size_t across[] = {kLast, kLast * kAlong, kLast * kAlong * kAlong};
                std::size_t axis = 0;
                while (axis < 3 && !(first[axis] && lower[axis])) ++axis;
                if ((axis < 3) != wantsShared) return;
                each(value, axis < 3 ? lower[axis][i + across[axis]] : expected);
            });
            endRun();
        }
    };
    Vector<bool> done(count, false);
    const std::size_t steps[] = {1, field.size[0], std::size_t{field.size[0]} * field.size[1]};
    for (std::size_t cell = 0; cell < field.blocks.size(); ++cell) {
        const std::size_t block = field.blocks[cell];
        if (block >= count || done[block]) continue;
        Lower lower{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (cell / steps[axis] % field.size[axis] == 0) continue;
            const std::size_t before = field.blocks[cell - steps[axis]];
            if (before < count && before != block) lower[axis] = values + before * BodyField::kBlockValues;
        }
        numbersOf(block, lower);
        done[block] = true;
    }
    for (std::size_t block = 0; block < count; ++block) {
        if (!done[block]) numbersOf(block, {});
    }
}

}  // namespace

std::vector<std::uint8_t> packBodyNumbers(const BodyField& field) {
    PackedWriter writer;
    const auto put = [&](std::int32_t value, std::int32_t expected) { writer.put(value - expected); };
    alongGrid(field.distances.data(), cornersOf(field), put);
    writer.endRun();
    std::int32_t last = 0;
    for (const std::uint16_t skin : field.skins) {
        writer.put(skin - last);
        last = skin;
    }
    writer.endRun();
    // 0: none; else how far it is from the one after the last.
    std::int32_t following = 0;
    for (const std::uint16_t block : field.blocks) {
        const std::int32_t step = block - following;
        writer.put(block == BodyField::kNoBlock ? 0 : step >= 0 ? step + 1 : step);
        if (block != BodyField::kNoBlock) following = block + 1;
    }
    writer.endRun();
    alongBlocks(field, field.values.data(), field.values.size() / BodyField::kBlockValues, put,
                [&] { writer.endRun(); });
    return writer.finish();
}

bool unpackBodyNumbers(std::span<const std::uint8_t> bytes, std::uint32_t blocks, BodyField& field) {
    if (blocks > BodyField::kNoBlock) return false;
    std::uint64_t corners = 1, cells = 1;
    for (const std::uint32_t along : field.size) {
        if (along == 0 || along >= kMostPackedCorners) return false;
        corners *= std::uint64_t{along} + 1;
        cells *= along;
        if (corners > kMostPackedCorners) return false;
    }
    const auto runs = [](std::uint64_t numbers) { return (numbers + kRunLength - 1) / kRunLength; };
    if ((2 * runs(corners) + runs(cells) + blocks) * kRunBits > std::uint64_t{bytes.size()} * 8) return false;

    PackedReader reader(bytes);
    const auto take = [&](auto& value, std::int32_t expected) {
        value = static_cast<std::remove_reference_t<decltype(value)>>(expected + reader.next());
    };
    field.distances.resize(static_cast<std::size_t>(corners));
    alongGrid(field.distances.data(), cornersOf(field), take);
    reader.endRun();
    field.skins.resize(static_cast<std::size_t>(corners));
    std::uint16_t last = 0;
    for (std::uint16_t& skin : field.skins) skin = last = static_cast<std::uint16_t>(last + reader.next());
    reader.endRun();
    field.blocks.resize(static_cast<std::size_t>(cells));
    std::int32_t following = 0;
    for (std::uint16_t& block : field.blocks) {
        const std::int32_t step = reader.next();
        block = BodyField::kNoBlock;
        if (step == 0) continue;
        block = static_cast<std::uint16_t>(following + (step > 0 ? step - 1 : step));
        following = block + 1;
    }
    reader.endRun();
    field.values.resize(std::size_t{blocks} * BodyField::kBlockValues);
    alongBlocks(field, field.values.data(), blocks, take, [&] { reader.endRun(); });
    return reader.endsHere();
}

}  // namespace hairloom::runtime
