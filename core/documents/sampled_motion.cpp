// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/documents/sampled_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <charconv>
#include <cmath>
#include <optional>

#include "core/base/parallel.h"

namespace hairloom {
namespace {

constexpr double kOnFrame = 1e-6;  ///< of a frame: rates are divided by each other

std::optional<double> numberIn(std::string_view text) {
    double value = 0;
    const char* const end = text.data() + text.size();
    const auto [at, code] = std::from_chars(text.data(), end, value);
    if (code != std::errc() || at != end || !std::isfinite(value)) return std::nullopt;
    return value;
}

/// The slope at a shape, by its neighbours where it has them.
Vec3f slopeAt(const std::vector<std::vector<Vec3f>>& shapes, std::size_t shape, std::size_t point) {
    if (shapes.size() < 2) return Vec3f::Zero();
    const std::size_t before = shape > 0 ? shape - 1 : 0, after = std::min(shape + 1, shapes.size() - 1);
    return (shapes[after][point] - shapes[before][point]) / static_cast<float>(after - before);
}

/// All points at a time in frames of the record from its first shape.
std::vector<Vec3f> shapeAt(const std::vector<std::vector<Vec3f>>& shapes, double at) {
    const double last = static_cast<double>(shapes.size() - 1),
                 nearest = std::clamp(std::round(at), 0.0, last);
    const auto known = static_cast<std::size_t>(nearest);
    if (std::abs(at - nearest) < kOnFrame) return shapes[known];
    std::vector<Vec3f> points(shapes.front().size());
    if (at < 0 || at > last) {
        const auto on = static_cast<float>(at - nearest);
        for (std::size_t p = 0; p < points.size(); ++p)
            points[p] = shapes[known][p] + on * slopeAt(shapes, known, p);
        return points;
    }
    const auto a = static_cast<std::size_t>(at), b = a + 1;
    const auto t = static_cast<float>(at - std::floor(at));
    const float ofB = t * t * (3 - 2 * t), slopeA = t * (1 - t) * (1 - t), slopeB = t * t * (t - 1);
    for (std::size_t p = 0; p < points.size(); ++p)
        points[p] = shapes[a][p] + ofB * (shapes[b][p] - shapes[a][p]) + slopeA * slopeAt(shapes, a, p) +
                    slopeB * slopeAt(shapes, b, p);
    return points;
}

}  // namespace

Result<Shutter> shutterFrom(std::string_view text, std::uint32_t samples) {
    const std::size_t colon = text.find(':');
    const auto open = numberIn(text.substr(0, colon));
    const auto close = colon == std::string_view::npos ? std::nullopt : numberIn(text.substr(colon + 1));
    if (!open || !close)
        return fail(fmt::format("the shutter \"{}\" is not two numbers", text),
                    "expected OPEN:CLOSE, as -0.25:0.25");
    if (!(*open < *close) || *open < -1 || *close > 1 || *close - *open > 1)
        return fail(fmt::format("the shutter opens at {} and closes at {}", *open, *close),
                    "expected it to open before it closes, between -1 and 1, at most one frame apart");
    if (samples < 2 || samples > kMaxShutterSamples)
        return fail(fmt::format("{} samples of a shutter", samples),
                    fmt::format("expected 2 to {}", kMaxShutterSamples));
    return Shutter{*open, *close, samples};
}

std::size_t framesAround(const MotionSampling& sampling) {
    const double reach = std::max(std::abs(sampling.shutter.open), std::abs(sampling.shutter.close));
    return static_cast<std::size_t>(std::ceil(reach * sampling.recordRate / sampling.framesPerSecond)) + 1;
}

SampledMotion sampleMotion(const std::vector<std::vector<Vec3f>>& shapes, const MotionSampling& sampling,
                           const std::atomic<bool>* cancelled) {
    assert(shapes.size() > sampling.before + sampling.after);
    const double perFrame = sampling.recordRate / sampling.framesPerSecond;
    const double span = static_cast<double>(shapes.size() - 1 - sampling.before - sampling.after);
    const auto count = static_cast<std::size_t>(std::floor(span / perFrame + kOnFrame)) + 1;
    SampledMotion made;
    StrandFrames& frames = made.frames;
    frames.framesPerSecond = sampling.framesPerSecond;
    frames.first = sampling.firstFrame;
    const Shutter& shutter = sampling.shutter;
    if (shutter.samples > 1) {
        frames.exposures.clear();
        // A shutter that is never shut has its last sample with the next frame's first.
        frames.closes = shutter.close - shutter.open >= 1;
        for (std::uint32_t i = 0; i + (frames.closes ? 1 : 0) < shutter.samples; ++i)
            frames.exposures.push_back(shutter.open +
                                       (shutter.close - shutter.open) * i / (shutter.samples - 1));
    }
    const std::size_t samples = count * frames.exposures.size() + (frames.closes ? 1 : 0);
    frames.points.resize(samples);
    const double last = static_cast<double>(shapes.size() - 1);
    const auto placeOf = [&](std::size_t sample) {
        return static_cast<double>(sampling.before) + (frames.numberOf(sample) - frames.first) * perFrame;
    };
    for (std::size_t i = 0; i < samples; ++i) {
        const double at = placeOf(i);
        if (at < -kOnFrame || at > last + kOnFrame)
            ++made.beyond;
        else if (std::abs(at - std::round(at)) >= kOnFrame)
            ++made.between;
    }
    parallelFor(samples, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end && (cancelled == nullptr || !*cancelled); ++i)
            frames.points[i] = shapeAt(shapes, placeOf(i));
    });
    return made;
}

}  // namespace hairloom
