// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// When the samples of a property stand, and at which times a record of several is taken.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace hairloom {

/// Seconds of the samples: `times` repeat after `cycle`. One time and a cycle are uniform; several and a
/// cycle are cyclic, as exposures within a frame; a cycle beyond 1e300 marks samples that have all their
/// times.
struct SampleTimes {
    double cycle = 1;
    std::vector<double> times{0.0};

    bool isCyclic() const { return cycle < 1e300; }
    double at(std::uint32_t sample) const;
    /// Whether the times of so many samples ascend and are numbers.
    bool ascend(std::uint32_t samples) const;
};

/// A time between two samples: `share` of the way from `before` to `after`, 0 … 1.
struct SampleMoment {
    std::uint32_t before = 0, after = 0;
    double share = 0;
    std::uint32_t nearest() const { return share < 0.5 ? before : after; }
};
/// The first sample before the first time, the last one after the last. `samples` ≥ 1; the times ascend.
SampleMoment momentAt(const SampleTimes& times, std::uint32_t samples, double seconds);

/// A property that moves.
struct MovingProperty {
    const SampleTimes* times;
    std::uint32_t samples;  ///< ≥ 2
    std::string name;       ///< for messages
};

struct RecordTimes {
    std::vector<double> seconds;  ///< of the frames, `1 / framesPerSecond` apart
    double framesPerSecond = 0;
    bool isResampled = false;  ///< frames lie between samples, or samples between frames
    std::string words;         ///< what was done; empty where frames are samples
};

inline constexpr std::uint32_t kMaxRecordFrames = 100'000;

/// Frames from the first to the last sample of all, at the rate that was asked for, or the file's own where
/// that is 0: that of the cycles, or of even times, else `stated` (0 where the file states none), else the
/// lowest rate up to 240 a second that meets every sample, else 24. `moving` is not empty. Errors: times that
/// do not ascend, more than kMaxRecordFrames frames.
Result<RecordTimes> recordTimes(std::span<const MovingProperty> moving, double stated, double asked);

/// The times of all samples of all, each once, and the rate as if they were even. Errors as above.
Result<RecordTimes> everySampleTime(std::span<const MovingProperty> moving);

}  // namespace hairloom
