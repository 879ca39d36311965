// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/sample_times.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace hairloom {
namespace {

using testing::HasSubstr;

constexpr double kAcyclic = 1e306;

TEST(SampleTimes, UniformCyclicAndAcyclic) {
    const SampleTimes uniform{0.5, {2}}, cyclic{1, {0, 0.25}}, acyclic{kAcyclic, {0, 1, 5}};
    EXPECT_EQ(uniform.at(4), 4);
    EXPECT_EQ(cyclic.at(4), 2);
    EXPECT_EQ(cyclic.at(5), 2.25);
    EXPECT_EQ(acyclic.at(2), 5);
    EXPECT_TRUE(uniform.ascend(1000));
    EXPECT_TRUE(cyclic.ascend(9));
    EXPECT_TRUE(acyclic.ascend(3));
    EXPECT_FALSE(acyclic.ascend(4)) << "has no fourth time";
    EXPECT_FALSE((SampleTimes{1, {0, 1.5}}.ascend(4))) << "the cycle is shorter than its times";
    EXPECT_FALSE((SampleTimes{0, {0}}.ascend(2)));
    EXPECT_FALSE((SampleTimes{1, {std::nan("")}}.ascend(1)));
    EXPECT_FALSE((SampleTimes{kAcyclic, {0, 2, 1}}.ascend(3)));
    EXPECT_FALSE((SampleTimes{1, {0}}.ascend(4'000'000'000u))) << "beyond what tells frames apart";
}

TEST(SampleTimes, MomentsLieBetweenTheirSamples) {
    const SampleTimes acyclic{kAcyclic, {0, 1, 5}};
    const auto at = [&](double seconds) { return momentAt(acyclic, 3, seconds); };
    EXPECT_EQ(at(-1).before, 0u);
    EXPECT_EQ(at(9).before, 2u);
    EXPECT_EQ(at(1).before, 1u);
    EXPECT_EQ(at(1).share, 0);
    EXPECT_EQ(at(4).before, 1u);
    EXPECT_EQ(at(4).after, 2u);
    EXPECT_DOUBLE_EQ(at(4).share, 0.75);
    EXPECT_EQ(at(4).nearest(), 2u);
    EXPECT_EQ(momentAt(acyclic, 1, 3).before, 0u);
}

RecordTimes timesOf(const std::vector<std::pair<SampleTimes, std::uint32_t>>& all, double stated = 0,
                    double asked = 0) {
    std::vector<MovingProperty> moving;
    for (const auto& [times, samples] : all) moving.push_back({&times, samples, "/x"});
    auto record = recordTimes(moving, stated, asked);
    EXPECT_TRUE(record) << record.error().message();
    return record ? std::move(*record) : RecordTimes();
}

TEST(RecordTimes, HaveTheFilesOwnRate) {
    const double frame = 1 / 24.0;
    const RecordTimes uniform = timesOf({{{frame, {frame}}, 10}});
    EXPECT_DOUBLE_EQ(uniform.framesPerSecond, 24);
    EXPECT_EQ(uniform.seconds.size(), 10u);
    EXPECT_EQ(uniform.words, "");
    const RecordTimes both = timesOf({{{frame, {frame}}, 5}, {{frame, {frame, 1.5 * frame}}, 10}});
    EXPECT_DOUBLE_EQ(both.framesPerSecond, 24);
    EXPECT_EQ(both.seconds.size(), 5u);
    // 29.97 as rounded times.
    std::vector<double> rounded;
    for (int i = 0; i < 100; ++i) rounded.push_back(std::round(1e5 * i * 1001 / 30000) / 1e5);
    const RecordTimes even = timesOf({{{kAcyclic, rounded}, 100}}, 24);
    EXPECT_NEAR(even.framesPerSecond, 29.97, 0.01);
    EXPECT_EQ(even.seconds.size(), 100u);
    const SampleTimes uneven{kAcyclic, {0, 0.1, 0.15, 0.4}};
    EXPECT_DOUBLE_EQ(timesOf({{uneven, 4}}).framesPerSecond, 20);
    EXPECT_EQ(timesOf({{uneven, 4}}).seconds.size(), 9u);
    EXPECT_THAT(timesOf({{uneven, 4}}).words,
                HasSubstr("4 samples from 0 to 0.4 s, at uneven times, became 9"));
    EXPECT_DOUBLE_EQ(timesOf({{uneven, 4}}, 30).framesPerSecond, 30) << "the file says it";
    EXPECT_DOUBLE_EQ(timesOf({{uneven, 4}}, 30, 60).framesPerSecond, 60) << "and somebody something else";
    EXPECT_DOUBLE_EQ(timesOf({{{kAcyclic, {0, std::sqrt(0.5), 1}}, 3}}).framesPerSecond, 24)
        << "no rate meets them";
}

TEST(RecordTimes, RefuseWhatIsNoTime) {
    const SampleTimes back{kAcyclic, {0, 2, 1}}, slow{3600, {0}};
    const MovingProperty wrong{&back, 3, "/hair"}, years{&slow, 10'000, "/hair"};
    const auto refused = recordTimes({&wrong, 1}, 0, 0);
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().message(), HasSubstr("/hair: the times of its samples do not ascend"));
    const auto many = recordTimes({&years, 1}, 0, 60);
    ASSERT_FALSE(many);
    EXPECT_THAT(many.error().message(), HasSubstr("at most 100000"));
}

}  // namespace
}  // namespace hairloom
