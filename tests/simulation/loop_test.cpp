// SPDX-License-Identifier: GPL-3.0-or-later
// Hair that repeats: seams of motion that is known in closed form, and what the blend makes of it.

#include "core/simulation/loop.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

namespace hairloom::test {
namespace {

using testing::HasSubstr;

constexpr std::uint64_t kFrames = 20, kBlend = 8;
constexpr float kRate = 50;
const std::vector<std::uint32_t> kOffsets{0, 4, 4, 7};  // the strand in the middle has no points

/// A strand that swings as a whole about its root, and one beside it that only drifts, both by the angle and
/// the distance of that frame.
std::vector<Vec3f> swung(double angle, double drift) {
    std::vector<Vec3f> points;
    for (int p = 0; p < 4; ++p) {
        const double reach = 0.1 * p;
        points.emplace_back(static_cast<float>(reach * std::sin(angle)),
                            static_cast<float>(-reach * std::cos(angle)), 0.0f);
    }
    for (int p = 0; p < 3; ++p)
        points.emplace_back(1.0f, -0.1f * static_cast<float>(p), static_cast<float>(p == 0 ? 0 : drift));
    return points;
}
/// Frame of the second repeat that is counted from its first; those before are negative.
std::vector<Vec3f> frameAt(std::int64_t number) {
    const double turn = 2 * std::numbers::pi * static_cast<double>(number) / kFrames;
    return swung(0.3 * std::sin(turn) + 0.02 * static_cast<double>(number) / kFrames,
                 0.004 * static_cast<double>(number) / kFrames);
}

LoopCloser closerWith(std::uint64_t blend, std::vector<std::vector<Vec3f>>* frames = nullptr) {
    LoopCloser loop(kOffsets, kFrames, blend, kRate);
    for (std::int64_t f = -static_cast<std::int64_t>(kFrames); f < 0; ++f) loop.lead(frameAt(f));
    for (std::uint64_t f = 0; f < kFrames; ++f) {
        const auto closed = loop.close(frameAt(static_cast<std::int64_t>(f)));
        if (frames != nullptr) frames->emplace_back(closed.begin(), closed.end());
    }
    return loop;
}

double largestDistance(const std::vector<Vec3f>& a, const std::vector<Vec3f>& b) {
    double largest = 0;
    for (std::size_t p = 0; p < a.size(); ++p) largest = std::max<double>(largest, (a[p] - b[p]).norm());
    return largest;
}

TEST(Loops, SeamsAreThoseOfTheMotion) {
    const LoopReport report = closerWith(0).report();
    // The tip of 0.3 m turns by 0.02 a repeat, a chord of 2 · 0.3 · sin 0.01, which is more than the drift.
    EXPECT_NEAR(report.before.mm, 600 * std::sin(0.01), 0.01);
    EXPECT_NEAR(report.before.mmPerSecond, report.before.mm * kRate, 1);
    EXPECT_EQ(report.after.mm, report.before.mm);
    EXPECT_EQ(report.after.mmPerSecond, report.before.mmPerSecond);
    EXPECT_FALSE(report.after.isClosed());
    EXPECT_EQ(report.blendMmPerSecond, 0);
    EXPECT_NEAR(report.headMm, 0, 1e-4);
}

TEST(Loops, ABlendClosesThemAndKeepsLengths) {
    std::vector<std::vector<Vec3f>> frames;
    const LoopReport report = closerWith(kBlend, &frames).report();
    EXPECT_EQ(report.after.mm, 0);
    // The last frame but one has all but 10/B³ of the way, to the first order.
    const double share = 1 - 1.0 / kBlend;
    const double left = 1 - share * share * share * (share * (6 * share - 15) + 10);
    EXPECT_NEAR(report.after.mmPerSecond, left * report.before.mm * kRate, 0.5);
    EXPECT_TRUE(report.after.isClosed());
    // 15/8 of the way per length of the blend is the steepest that the curve is.
    EXPECT_LE(report.blendMmPerSecond, 1.875 * report.before.mm * kRate / kBlend * 1.01);
    EXPECT_GT(report.blendMmPerSecond, report.before.mm * kRate / kBlend);

    for (std::uint64_t f = 0; f < kFrames - kBlend; ++f)
        EXPECT_EQ(frames[f], frameAt(static_cast<std::int64_t>(f))) << f;
    EXPECT_EQ(frames.back(), frameAt(-1));
    for (const auto& frame : frames) {
        for (const std::uint32_t p : {1u, 2u, 3u})
            EXPECT_NEAR((frame[p] - frame[p - 1]).norm(), 0.1f, 1e-6f) << "the chord of a turn is shorter";
    }
    // No step is longer than the longest of the motion and what the blend adds.
    double longest = 0;
    for (std::int64_t f = 0; f < static_cast<std::int64_t>(kFrames); ++f)
        longest = std::max(longest, largestDistance(frameAt(f), frameAt(f - 1)));
    longest += 1e-3 * report.blendMmPerSecond / kRate;
    for (std::uint64_t f = 0; f < kFrames; ++f)
        EXPECT_LE(largestDistance(frames[f], frames[(f + kFrames - 1) % kFrames]), longest + 1e-6) << f;
}

TEST(Loops, RepeatsThatEndAlikeAreSettled) {
    LoopCloser loop(kOffsets, kFrames, 2, kRate);
    const auto repeat = [&](double off) {
        for (std::uint64_t f = 0; f < kFrames; ++f) loop.lead(swung(0, off));
        return loop.endRepeat();
    };
    EXPECT_FALSE(repeat(0.01)) << "there is none before";
    EXPECT_NEAR(repeat(0.004)->mm, 6, 1e-3);
    EXPECT_NEAR(repeat(0.0038)->mm, 0.2, 1e-3);
    const auto settled = repeat(0.0037);
    EXPECT_TRUE(settled->isClosed()) << settled->mm << " mm, " << settled->mmPerSecond << " mm/s";
}

/// Turns about the vertical axis, so fast, and starts again after a time.
class Turning : public HeadMotion {
  public:
    Turning(float turnsPerSecond, float period) : turns_(turnsPerSecond), period_(period) {}
    HeadPose poseAt(float time) const override {
        HeadPose pose;
        const float angle = 2 * std::numbers::pi_v<float> * turns_ * std::fmod(time, period_);
        pose.head_ws = Eigen::AngleAxisf(angle, Vec3f::UnitY());
        return pose;
    }

  private:
    float turns_, period_;
};

TEST(Loops, AHeadThatDoesNotRepeatIsRefusedWithWhy) {
    const Groom groom = makeGroom({0, 2}, {{0.1f, 1, 0}, {0.2f, 1, 0}});
    const FramePace pace{60, 0};
    EXPECT_TRUE(checkHeadRepeats(Turning(1, 1000), groom, pace, 60));
    const auto other = checkHeadRepeats(Turning(1, 1000), groom, pace, 59);
    ASSERT_FALSE(other);
    EXPECT_THAT(other.error().message(), HasSubstr("does not repeat every 59 frames"));
    // It comes back every half second, and jumps there by half a turn: 0.4 m at the tip.
    const auto jumps = checkHeadRepeats(Turning(1, 0.5f), groom, pace, 30);
    ASSERT_FALSE(jumps);
    EXPECT_THAT(jumps.error().message(), HasSubstr("jumps"));
}

}  // namespace
}  // namespace hairloom::test
