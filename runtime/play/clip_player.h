// SPDX-License-Identifier: MIT
#pragma once
// Plays an asset's clip: the two frames around a time, and what lies between them.

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "hairloom/asset.h"
#include "hairloom/hairloom.h"
#include "hairloom/memory.h"

namespace hairloom::runtime {

/// Where a clip is at a time.
struct ClipMoment {
    std::uint32_t from = 0, to = 0;  ///< frames
    float share = 0;                 ///< of `to`
    bool moves = false;              ///< not where the clip has ended, or has not begun
};
ClipMoment clipMoment(const asset::Clip& clip, double seconds, bool loops);

class ClipPlayer {
  public:
    /// Bytes that it holds for strands of so many points.
    static std::size_t bytesFor(std::size_t strands, std::size_t points);
    std::size_t bytes() const;

    /// Decodes the two frames of these strands (ascending) of a level. The content of the asset is sound, and
    /// it has a clip. An error says which bits are none, and what was decoded is forgotten. Asks for memory
    /// where the asset is another than before.
    std::optional<AssetError> decode(const Asset& asset, const ClipMoment& moment,
                                     std::span<const std::uint32_t> strands, std::uint32_t level,
                                     const Host& host);

    /// Of point `point` behind the root of a strand that was decoded: from its root, in metres, on a head
    /// that has not turned, at the moment and in its two frames' difference.
    struct Place {
        Float3 offset, moved;
    };
    Place place(std::size_t strand, std::size_t point, float share) const {
        const std::size_t at = 3 * (offsets_[strand] - strand + point - 1);
        const auto cell = [&](const std::int32_t* cells) {
            return Float3{static_cast<float>(cells[at]) * step_, static_cast<float>(cells[at + 1]) * step_,
                          static_cast<float>(cells[at + 2]) * step_};
        };
        const Float3 begin = cell(cells_[from_].data()), moved = cell(cells_[to_].data()) - begin;
        return {begin + moved * share, moved};
    }
    bool isSame(const Asset& asset) const { return asset.identity() == identity_; }

  private:
    /// Frames from..to of a block, whose bits are read from where they were left, or from its begin.
    struct Run {
        std::uint32_t block = 0, from = 0, count = 0;
    };
    struct Plan {
        std::array<Run, 2> runs;
        std::size_t count = 0;
    };
    void take(const Asset& asset);
    Plan planOf(const asset::Clip& clip, const ClipMoment& moment) const;
    bool decodeStrand(const Asset& asset, const Plan& plan, std::uint32_t strand);
    void forget() { frames_ = {kNoFrame, kNoFrame}; }

    static constexpr std::uint32_t kNoFrame = 0xffffffffu;
    std::array<std::uint64_t, 3> identity_{};
    std::uint32_t level_ = 0;
    float step_ = 0;                 ///< metres of a cell
    Vector<std::uint32_t> offsets_;  ///< of the strands' points
    Vector<std::int32_t> rest_;      ///< as clipRest()
    std::array<Vector<std::int32_t>, 2> cells_;
    std::array<std::uint32_t, 2> frames_{kNoFrame, kNoFrame};  ///< that are in cells_
    std::size_t last_ = 0;                                     ///< which of them was decoded last
    std::size_t from_ = 0, to_ = 0;                            ///< which of them are those of the moment
    Vector<std::uint64_t> bits_;    ///< of each strand, that were read of the block of `last_`
    Vector<std::uint8_t> damaged_;  ///< strands that were found to be so
};

}  // namespace hairloom::runtime
