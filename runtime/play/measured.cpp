// SPDX-License-Identifier: MIT
// What is found out by playing copies of an instance: how far levels of detail are off, how fast the machine
// is.
#include <algorithm>
#include <cmath>

#include "engine/checks.h"
#include "play/instance.h"

namespace hairloom::runtime {
namespace {

// Levels are measured on half a second of frames of 1/60 s.
constexpr int kMeasuredFrames = 30;
constexpr int kComparedEvery = 6;
constexpr float kMeasuredWind = 3.0f;  ///< m/s
enum class Measured { still, head, wind };

/// Errors are said to be so much larger than those measured: other heads and winds have others.
constexpr float kReserve = 1.5f;

// Speed is measured on so many frames after the first ones.
constexpr int kRatedAfter = 6, kRatedFrames = 24;

Matrix34 nodded(float seconds, Float3 pivot) {
    const float angle = 0.25f * std::sin(7.85f * seconds), c = std::cos(angle), s = std::sin(angle);
    return {1, 0, 0,  0,
            0, c, -s, pivot.y - c * pivot.y + s * pivot.z,
            0, s, c,  pivot.z - s * pivot.y - c * pivot.z};
}

/// A frame `f` of 1/60 s after rest, with what it points at.
struct MeasuredFrame {
    MeasuredFrame(int f, bool nods, bool blows, Float3 pivot)
        : head(nods ? nodded(kUsualFrame * static_cast<float>(f), pivot) : kIdentity34),
          wind{blows ? kMeasuredWind : 0, 0, 0} {
        frame.size = sizeof frame;
        frame.dt = kUsualFrame;
        frame.time = static_cast<double>(kUsualFrame * static_cast<float>(f));
        frame.head = head.data();
        frame.wind = wind.data();
    }
    MeasuredFrame(const MeasuredFrame&) = delete;
    MeasuredFrame& operator=(const MeasuredFrame&) = delete;
    Matrix34 head;
    std::array<float, 3> wind;
    hl_frame frame{};
};

float rootMeanSquare(std::span<const Float3> a, std::span<const Float3> b) {
    double sum = 0;
    for (std::size_t p = 0; p < a.size(); ++p) {
        const Float3 apart = a[p] - b[p];
        sum += static_cast<double>(dot(apart, apart));
    }
    return a.empty() ? 0 : static_cast<float>(std::sqrt(sum / static_cast<double>(a.size())));
}

}  // namespace

void Instance::measureLevels(LevelSet& set) {
    const auto play = [&](Instance& hair, Measured what, const auto& compare) {
        for (int f = 1; f <= kMeasuredFrames; ++f) {
            const MeasuredFrame given(f, what == Measured::head, what == Measured::wind, pivot_);
            hair.asleep_ = false;  // so that it is stepped, and its motion held
            hair.step(given.frame);
            if (f % kComparedEvery == 0) {
                hair.showPositions();
                compare(static_cast<std::size_t>(f / kComparedEvery - 1));
            }
        }
    };
    for (const Measured what : {Measured::still, Measured::head, Measured::wind}) {
        Vector<Vector<Float3>> finest(kMeasuredFrames / kComparedEvery);
        Instance exact = *this;
        play(exact, what, [&](std::size_t at) { finest[at] = exact.positions_; });
        for (std::uint32_t level = 1; level < HL_LEVEL_COUNT; ++level) {
            LevelError& error = set.errors[level];
            Instance coarse = *this;
            coarse.setLevel(level, 1);
            coarse.levels_->fading = false;
            float worst = 0;
            play(coarse, what, [&](std::size_t at) {
                const float apart = kReserve * rootMeanSquare(coarse.positions_, finest[at]);
                if (what == Measured::still) worst = std::max(worst, apart);
                const float speed = what == Measured::head ? coarse.levels_->motion : coarse.levels_->wind;
                if (what != Measured::still && speed > 0)
                    worst = std::max(worst, (apart - error.still) / speed);
            });
            float LevelError::*const part = what == Measured::still  ? &LevelError::still
                                            : what == Measured::head ? &LevelError::head
                                                                     : &LevelError::wind;
            error.*part = std::max(worst, set.errors[level - 1].*part);
        }
    }
}

Outcome Instance::measureSpeed(const std::function<std::uint64_t()>& nanoseconds, float& speed) const {
    double predicted = 0, measured = 0;
    // Hair that is rigid takes no time to speak of.
    for (std::uint32_t number = 0; number < (levels_ ? HL_LEVEL_RIGID : 1); ++number) {
        Instance hair = *this;
        hair.setClock({});
        MeasuredFrame rest(0, false, false, pivot_);
        hair.reset(rest.frame);
        if (levels_) hair.setLevel(number, 1);
        Vector<Float3> places(std::max(hairPoints(), positions_.size()));
        hl_read read{};
        read.hairs = hairs_ ? 1 : 0;
        read.positions = {places.data(), places.size() * sizeof(Float3), sizeof(Float3)};
        Vector<std::uint64_t> took;
        for (int f = 1; f <= kRatedAfter + kRatedFrames; ++f) {
            const MeasuredFrame given(f, true, true, pivot_);
            const std::uint64_t begin = nanoseconds();
            hair.step(given.frame);
            hair.read(read, false);
            if (f > kRatedAfter) took.push_back(nanoseconds() - begin);
        }
        std::nth_element(took.begin(), took.begin() + kRatedFrames / 2, took.end());
        measured += static_cast<double>(took[kRatedFrames / 2]) * 1e-6;
        predicted += static_cast<double>(hair.describeLevel(number).milliseconds);
    }
    if (!(measured > 0) || !std::isfinite(predicted / measured))
        return Refusal{HL_BAD_VALUE, "the clock stands still; expected nanoseconds"};
    speed = static_cast<float>(predicted / measured);
    return std::nullopt;
}

}  // namespace hairloom::runtime
