// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How frames of a take become few bytes: positions on a grid, what is left of them behind a prediction from
// the frames and points before, and that as bytes of variable length. docs/formats/take.md has the layout.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/math.h"
#include "core/base/result.h"

namespace hairloom::take {

/// The grid, metres: a coordinate is at most half of it from where it was.
inline constexpr float kGrid = 1e-4f;
/// Metres, of a point within 10 m of the world's origin: half the diagonal of a cell, and the rounding of its
/// coordinates there.
inline constexpr float kLargestError = 0.088e-3f;
/// Of a coordinate, in cells: 100 km.
inline constexpr std::int32_t kFarthest = 1'000'000'000;

/// A frame on the grid: coordinates of all its vectors, vector after vector.
using GridFrame = std::vector<std::int32_t>;

/// Errors: one that is not finite, or farther away than the grid reaches; it names the vector's number.
Result<GridFrame> onGrid(std::span<const Vec3f> vectors);
Vec3f offGrid(const std::int32_t* coordinates);

/// Coordinates of frames one after another. Both sides begin anew at the first frame of a block.
class Predictor {
  public:
    /// `starts`: the numbers of vectors that no vector before them predicts, ascending, the first 0; and how
    /// many vectors there are.
    Predictor(std::vector<std::uint32_t> starts, std::size_t vectors);

    void beginBlock();
    /// Appends the frame to `bytes`.
    void write(const GridFrame& frame, std::vector<std::byte>& bytes);
    /// Takes the next frame from the front of `bytes`. Errors: they end in it, or say what no writer says.
    Result<GridFrame> read(std::span<const std::byte>& bytes);

    /// No frame takes more bytes.
    static std::size_t mostBytes(std::size_t vectors);

  private:
    struct Way;
    std::uint64_t cost(const GridFrame& frame, Way way) const;
    std::int64_t inTime(std::size_t coordinate, std::uint32_t order) const;
    template <class Visit>
    void eachResidual(const GridFrame& frame, Way way, Visit&& visit) const;

    std::vector<std::uint32_t> placeInRun_;  ///< of each vector behind its start, up to 2
    GridFrame last_, beforeLast_;            ///< empty where a block has none yet
};

/// Deflated, with the same bytes on every machine of the same zlib.
Result<std::vector<std::byte>> packed(std::span<const std::byte> bytes);
/// Errors: damage, or another size than `size`, which the caller has checked.
Result<std::vector<std::byte>> unpacked(std::span<const std::byte> bytes, std::size_t size);

}  // namespace hairloom::take
