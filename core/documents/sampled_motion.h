// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Shapes that were recorded frame by frame at the times that a file wants: another rate, and several times
// while a shutter is open.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/math.h"
#include "core/base/result.h"
#include "exporters/strands.h"

namespace hairloom {

/// When a camera sees a frame, in frames of the file from its number: from `open` to `close`, at most 1
/// apart, −1 … 1. Samples stand evenly, first and last at the ends.
struct Shutter {
    double open = 0, close = 0;
    std::uint32_t samples = 1;  ///< 2 … kMaxShutterSamples; 1: none, and frames are seen at their numbers
};
inline constexpr std::uint32_t kMaxShutterSamples = 64;

/// "OPEN:CLOSE" with so many samples. Errors: no two numbers, out of range or order.
Result<Shutter> shutterFrom(std::string_view text, std::uint32_t samples);

/// What of a record a file has.
struct MotionSampling {
    double recordRate = 60;       ///< frames of the record a second
    std::size_t before = 0;       ///< shapes that stand before the first frame of the file, for its shutter
    std::size_t after = 0;        ///< likewise behind the last
    double framesPerSecond = 60;  ///< of the file
    double firstFrame = 0;        ///< number of the file's first frame
    Shutter shutter;
};
struct SampledMotion {
    StrandFrames frames;
    std::size_t between = 0;  ///< samples that lie between frames of the record, on curves through these
    std::size_t beyond = 0;   ///< that lie before or behind the record, where points go on as at its end
};
/// How many shapes of a record the shutter and the curves reach beyond its first and last frame.
std::size_t framesAround(const MotionSampling& sampling);

/// Shapes as the file has them, of at least one in it. Samples at frames of the record have its bits.
/// Once it is cancelled, shapes that are left stay empty.
SampledMotion sampleMotion(const std::vector<std::vector<Vec3f>>& shapes, const MotionSampling& sampling,
                           const std::atomic<bool>* cancelled = nullptr);

}  // namespace hairloom
