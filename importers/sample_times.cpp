// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/sample_times.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace hairloom {
namespace {

constexpr double kSame = 1e-3;  ///< of a frame: times are sums of rounded steps
constexpr double kUsualRate = 24;

bool isWhole(double value) {
    return std::abs(value - std::round(value)) < kSame;
}

/// Steps of equal length: that length; 0 where they are not.
double evenStep(const SampleTimes& times, std::uint32_t samples) {
    const double first = times.at(0), step = (times.at(samples - 1) - first) / (samples - 1);
    for (std::uint32_t i = 1; i + 1 < samples; ++i) {
        if (!isWhole((times.at(i) - first) / step)) return 0;
    }
    return step;
}

/// The lowest rate at which every sample of all is a frame; 0 where none up to 240 is.
double commonRate(std::span<const MovingProperty> moving, double start) {
    constexpr int kHighest = 240;
    for (int rate = 1; rate <= kHighest; ++rate) {
        const bool meets = std::ranges::all_of(moving, [&](const MovingProperty& property) {
            for (std::uint32_t i = 0; i < property.samples; ++i) {
                if (!isWhole((property.times->at(i) - start) * rate)) return false;
            }
            return true;
        });
        if (meets) return rate;
    }
    return 0;
}

double ownRate(std::span<const MovingProperty> moving, double stated, double start) {
    double rate = 0;
    for (const MovingProperty& property : moving) {
        if (property.times->isCyclic()) rate = std::max(rate, 1 / property.times->cycle);
    }
    if (rate > 0) return rate;
    for (const MovingProperty& property : moving) {
        const double step = evenStep(*property.times, property.samples);
        if (step > 0) rate = std::max(rate, 1 / step);
    }
    if (rate > 0) return rate;
    if (stated > 0) return stated;
    rate = commonRate(moving, start);
    return rate > 0 ? rate : kUsualRate;
}

Status checkTimes(const MovingProperty& property) {
    if (property.times->ascend(property.samples)) return {};
    return fail(fmt::format("{}: the times of its samples do not ascend", property.name),
                "expected each time after the one before");
}

}  // namespace

double SampleTimes::at(std::uint32_t sample) const {
    const std::size_t count = times.size();
    if (sample < count) return times[sample];
    if (!isCyclic()) return times.back();
    return times[sample % count] + cycle * static_cast<double>(sample / count);
}

bool SampleTimes::ascend(std::uint32_t samples) const {
    constexpr double kFar = 1e9;  // seconds; beyond it steps of a frame are lost
    const auto stored = static_cast<std::uint32_t>(std::min<std::size_t>(times.size(), samples));
    if (!(std::abs(times[0]) < kFar)) return false;
    for (std::uint32_t i = 1; i < stored; ++i) {
        if (!(times[i] > times[i - 1]) || !(times[i] < kFar)) return false;
    }
    if (stored == samples) return true;
    if (!isCyclic()) return false;
    return cycle > 0 && times.back() - times.front() < cycle && cycle * samples < kFar;
}

SampleMoment momentAt(const SampleTimes& times, std::uint32_t samples, double seconds) {
    std::uint32_t low = 0, high = samples - 1;
    if (!(seconds > times.at(low))) return {low, low, 0};
    if (seconds >= times.at(high)) return {high, high, 0};
    while (high - low > 1) {
        const std::uint32_t middle = low + (high - low) / 2;
        (times.at(middle) <= seconds ? low : high) = middle;
    }
    const double share = (seconds - times.at(low)) / (times.at(high) - times.at(low));
    if (share < kSame) return {low, low, 0};
    if (share > 1 - kSame) return {high, high, 0};
    return {low, high, share};
}

Result<RecordTimes> everySampleTime(std::span<const MovingProperty> moving) {
    RecordTimes record;
    for (const MovingProperty& property : moving) {
        if (auto status = checkTimes(property); !status) return tl::unexpected(status.error());
        if (record.seconds.size() + property.samples > kMaxRecordFrames)
            return fail(fmt::format("{} has {} samples", property.name, property.samples),
                        fmt::format("expected at most {}", kMaxRecordFrames));
        for (std::uint32_t i = 0; i < property.samples; ++i) record.seconds.push_back(property.times->at(i));
    }
    std::ranges::sort(record.seconds);
    record.seconds.erase(std::unique(record.seconds.begin(), record.seconds.end()), record.seconds.end());
    const double length = record.seconds.back() - record.seconds.front();
    record.framesPerSecond =
        length > 0 ? static_cast<double>(record.seconds.size() - 1) / length : kUsualRate;
    return record;
}

Result<RecordTimes> recordTimes(std::span<const MovingProperty> moving, double stated, double asked) {
    double start = HUGE_VAL, end = -HUGE_VAL;
    std::uint32_t most = 0;
    for (const MovingProperty& property : moving) {
        if (auto status = checkTimes(property); !status) return tl::unexpected(status.error());
        start = std::min(start, property.times->at(0));
        end = std::max(end, property.times->at(property.samples - 1));
        most = std::max(most, property.samples);
    }
    RecordTimes record;
    record.framesPerSecond = asked > 0 ? asked : ownRate(moving, stated, start);
    const double frames = std::floor((end - start) * record.framesPerSecond + kSame) + 1;
    if (!(frames <= kMaxRecordFrames))
        return fail(fmt::format("{:.6g} seconds at {:.6g} frames a second are {:.0f} frames", end - start,
                                record.framesPerSecond, frames),
                    fmt::format("expected at most {}: ask for fewer a second (--fps)", kMaxRecordFrames));
    for (std::uint32_t frame = 0; frame < static_cast<std::uint32_t>(frames); ++frame)
        record.seconds.push_back(start + frame / record.framesPerSecond);
    bool isUneven = false;
    for (const MovingProperty& property : moving) {
        for (const double seconds : record.seconds)
            record.isResampled =
                record.isResampled || momentAt(*property.times, property.samples, seconds).share != 0;
        for (std::uint32_t i = 0; i < property.samples; ++i)
            record.isResampled =
                record.isResampled || !isWhole((property.times->at(i) - start) * record.framesPerSecond);
        isUneven =
            isUneven || (!property.times->isCyclic() && evenStep(*property.times, property.samples) == 0);
    }
    if (record.isResampled || isUneven)
        record.words = fmt::format("{} samples from {:.6g} to {:.6g} s{} became {} frames at {:.6g} a second",
                                   most, start, end, isUneven ? ", at uneven times," : "",
                                   record.seconds.size(), record.framesPerSecond);
    record.isResampled = record.isResampled || isUneven;
    return record;
}

}  // namespace hairloom
