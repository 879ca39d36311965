// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// When the frames of a record are, from the times that a file's samples have.

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace hairloom {

struct FrameTimes {
    std::vector<double> seconds;  ///< evenly after each other
    double rate = 0;              ///< frames a second
    std::string said;             ///< where frames lie elsewhere than samples: what was done; else empty
};

/// `samples` ascend, in seconds. `asked` frames a second, or, where that is 0, the file's own rate: that of
/// samples that are even, else `usual` (0: none) where all samples fall on its frames, else the rate that all
/// fall on, else as many frames as keep the samples' least distance. Nothing of fewer than two samples, and
/// of more frames than are kept.
std::optional<FrameTimes> frameTimes(std::span<const double> samples, double asked, double usual);

}  // namespace hairloom
