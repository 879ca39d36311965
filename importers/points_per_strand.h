// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Where strands begin and end in a plain run of points, as files of reconstructed hair hold them.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "importers/raw_strands.h"

namespace hairloom {

/// The number of points that every strand of the run has, where the points tell it: at least seven in eight
/// steps from one strand to the next are more than twice as long as any step within these two. 0 where no
/// number of points has that, or more than one, and for less than two strands.
std::uint32_t guessPointsPerStrand(std::span<const Vec3f> points);

/// How a run of points was cut.
struct StrandRuns {
    std::vector<std::uint32_t> offsets{0};
    std::uint32_t guessed = 0;  ///< points a strand that were guessed; 0 where they were asked for
};

/// Cuts a run of points into strands of `asked` points, or of as many as the points tell where that is 0.
/// Errors: a number that does not divide the points, nothing to tell it from.
Result<StrandRuns> cutIntoStrands(const std::string& file, std::span<const Vec3f> points,
                                  std::uint32_t asked);

/// Makes the runs the strands of `raw`, and says what was guessed. Which end is the root stays open.
void noteRuns(StrandRuns& runs, RawStrands& raw);

}  // namespace hairloom
