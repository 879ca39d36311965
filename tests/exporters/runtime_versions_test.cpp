// SPDX-License-Identifier: GPL-3.0-or-later
// hairloom.h for programs that were compiled at another time, saved states, paused games, logs and clocks.

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <memory>

#include "tests/exporters/decorated_sample.h"

namespace hairloom::test {
namespace {

using game::Asset;
using game::Frame;
using game::Instance;
using testing::HasSubstr;
class RuntimeVersions : public RuntimeReads {};

TEST_F(RuntimeVersions, StructsOfOlderAndNewerCallersAreServed) {
    open(decorated());
    make(HL_HAIRS | HL_LEVELS);
    // A program of before: it calls the function, with a struct that ends where it ended then.
    struct {
        hl_asset_info info;
        char beyond[16];
    } old;
    std::memset(&old, 0x5a, sizeof old);
    ASSERT_EQ((hl_asset_describe)(asset_.get(), &old.info, &error_), HL_OK);
    EXPECT_EQ(old.info.guides, info_.guides);
    EXPECT_EQ(old.info.layers, 0x5a5a5a5au) << "what it does not know of is not written";
    // One of tomorrow.
    char tomorrow[256];
    std::memset(tomorrow, 0x5a, sizeof tomorrow);
    ASSERT_EQ(hl_asset_describe_sized(asset_.get(), reinterpret_cast<hl_asset_info*>(tomorrow), 160, &error_),
              HL_OK);
    EXPECT_EQ(std::memcmp(tomorrow, &info_, sizeof info_), 0);
    for (std::size_t b = sizeof info_; b < 160; ++b) EXPECT_EQ(tomorrow[b], 0);
    EXPECT_EQ(tomorrow[160], 0x5a);
    for (const std::size_t garbage : {std::size_t{0}, std::size_t{1}, std::size_t{84}, std::size_t{113},
                                      std::size_t{1} << 20, ~std::size_t{0}}) {
        EXPECT_EQ(hl_asset_describe_sized(asset_.get(), &old.info, garbage, &error_), HL_WRONG_SIZE);
        EXPECT_THAT(error_.words, HasSubstr("bytes of hl_asset_info"));
        Frame frame;
        frame.size = garbage == 84 ? 124 : garbage;
        EXPECT_FALSE(hair_.step(frame, &error_));
        EXPECT_EQ(error_.code, HL_WRONG_SIZE);
        hl_crowd_limits limits;
        hl_crowd_limits_init(&limits);
        limits.size = garbage == 84 ? 20 : garbage;
        hl_viewed viewed{hair_.get(), 100, 0, 0, 0};
        EXPECT_EQ(hl_crowd_plan(&limits, &viewed, 1, nullptr, &error_), HL_WRONG_SIZE);
        hl_crowd_limits_init(&limits);
        const std::size_t size = garbage == 84 ? 20 : garbage;
        EXPECT_EQ(hl_crowd_plan_sized(&limits, &viewed, size, 1, nullptr, 12, &error_), HL_WRONG_SIZE);
    }
    struct {
        hl_frame frame;
        std::uint64_t more[2];
    } newer{};
    hl_frame_init(&newer.frame);
    newer.frame.size = sizeof newer;
    EXPECT_EQ(hl_instance_step(hair_.get(), &newer.frame, &error_), HL_OK) << error_.what();
    newer.more[1] = 1;
    EXPECT_EQ(hl_instance_step(hair_.get(), &newer.frame, &error_), HL_NEWER);
    EXPECT_THAT(error_.words, HasSubstr("does not know"));
    // Characters farther apart than this library knows them to be.
    struct Wide {
        hl_viewed viewed;
        std::uint64_t more;
    };
    Instance second;
    ASSERT_TRUE(second.copy(hair_));
    std::array<Wide, 2> wide{Wide{{hair_.get(), 0, 9, 9, 9}, 77}, Wide{{second.get(), 2000, 9, 9, 9}, 78}};
    hl_crowd_limits limits;
    hl_crowd_limits_init(&limits);
    hl_crowd_report report;
    ASSERT_EQ(hl_crowd_plan_sized(&limits, &wide[0].viewed, sizeof(Wide), 2, &report, sizeof report, &error_),
              HL_OK);
    EXPECT_EQ(wide[0].viewed.level, static_cast<std::uint32_t>(HL_LEVEL_RIGID));
    EXPECT_NE(wide[1].viewed.level, 9u);
    EXPECT_EQ(wide[0].more + wide[1].more, 155u);
    EXPECT_EQ(hl_version(), static_cast<std::uint32_t>(HL_VERSION));
    hl_build build{};
    build.size = sizeof build;
    ASSERT_EQ(hl_build_info(&build, &error_), HL_OK);
    EXPECT_GE(build.lanes, 1u);
    EXPECT_GT(std::strlen(build.instruction_set), 0u);
    build.size = 3;
    EXPECT_EQ(hl_build_info(&build, &error_), HL_WRONG_SIZE);
}

TEST_F(RuntimeVersions, SavedInstancesRunOnWithTheSameBits) {
    for (const auto model : {runtime::StrandModel::rods, runtime::StrandModel::springs}) {
        Groom groom = decorated();
        groom.simulation.strandModel = model;
        if (model == runtime::StrandModel::springs) groom.simulation.substeps = 8;
        open(groom);
        for (std::uint32_t level = 0; level < HL_LEVEL_COUNT; ++level) {
            make(HL_HAIRS | HL_LEVELS);
            for (int f = 1; f <= 6; ++f) step(hair_, f);
            ASSERT_TRUE(hair_.setLevel(level, 0.7f));
            for (int f = 7; f <= 9; ++f) step(hair_, f);
            std::size_t size = 0;
            ASSERT_EQ(hl_instance_save(hair_.get(), nullptr, 0, &size, &error_), HL_OK);
            std::vector<std::byte> saved(size);
            EXPECT_EQ(hl_instance_save(hair_.get(), saved.data(), size - 1, &size, &error_), HL_WRONG_SIZE);
            ASSERT_EQ(hl_instance_save(hair_.get(), saved.data(), size, &size, &error_), HL_OK);
            Instance other;
            ASSERT_TRUE(other.make(asset_, HL_HAIRS | HL_LEVELS));
            ASSERT_EQ(hl_instance_load(other.get(), saved.data(), size, &error_), HL_OK) << error_.what();
            std::vector<float> a, b;
            for (int f = 10; f <= 14; ++f) {
                EXPECT_EQ(hair_.hash(), other.hash()) << level << " before frame " << f;
                step(hair_, f);
                step(other, f);
                ASSERT_TRUE(hair_.readHairs(a));
                ASSERT_TRUE(other.readHairs(b));
                EXPECT_EQ(a, b);
            }
            const std::uint64_t hash = other.hash();
            // Any byte: refused, and nothing changed.
            for (std::size_t byte = 0; byte < size; byte += 1 + size / 200) {
                std::vector<std::byte> damaged = saved;
                damaged[byte] ^= std::byte{0x10};
                EXPECT_NE(hl_instance_load(other.get(), damaged.data(), size, &error_), HL_OK) << byte;
            }
            for (const std::size_t shorter : {std::size_t{0}, std::size_t{7}, size / 2, size - 1})
                EXPECT_EQ(hl_instance_load(other.get(), saved.data(), shorter, &error_), HL_DAMAGED);
            EXPECT_EQ(other.hash(), hash);
            Instance plain;
            ASSERT_TRUE(plain.make(asset_, HL_HAIRS));
            EXPECT_EQ(hl_instance_load(plain.get(), saved.data(), size, &error_), HL_DAMAGED);
        }
    }
}

TEST_F(RuntimeVersions, APausedGameMovesNothing) {
    open(decorated());
    make(HL_GUIDES);
    for (int f = 1; f <= 3; ++f) step(hair_, f);
    const std::uint64_t hash = hair_.hash();
    Frame frame(0);
    std::array<float, 12> head{1, 0, 0, 5, 0, 1, 0, 0, 0, 0, 1, 0};
    frame.head = head.data();
    EXPECT_TRUE(hair_.step(frame, &error_)) << error_.what();
    EXPECT_EQ(hair_.hash(), hash);
    for (const float dt : {-1.0f, 1e-7f, std::numeric_limits<float>::infinity()}) {
        frame.dt = dt;
        EXPECT_FALSE(hair_.step(frame, &error_)) << static_cast<double>(dt);
    }
}

TEST_F(RuntimeVersions, ALogOfTheHostIsTakenAndHearsNothingOfSoundHair) {
    open(decorated());
    std::string heard;
    hl_host host;
    hl_host_init(&host);
    host.user = &heard;
    host.log = [](void* user, const char* words, std::size_t bytes) {
        static_cast<std::string*>(user)->append(words, bytes);
    };
    hl_instance* made = nullptr;
    ASSERT_EQ(hl_instance_make_hosted(asset_.get(), HL_GUIDES, &host, &made, &error_), HL_OK)
        << error_.what();
    const std::unique_ptr<hl_instance, void (*)(hl_instance*)> hair(made, hl_instance_free);
    Frame frame;
    ASSERT_EQ(hl_instance_step(made, &frame, &error_), HL_OK);
    EXPECT_EQ(heard, "");
    host.size = 12;
    EXPECT_EQ(hl_instance_make_hosted(asset_.get(), HL_GUIDES, &host, &made, &error_), HL_WRONG_SIZE);
}

TEST_F(RuntimeVersions, LevelsComeMeasuredAndSoInLittleTime) {
    Groom groom = decorated();
    open(groom);
    EXPECT_EQ(info_.measured_levels, 1u);
    make(HL_LEVELS);
    for (std::uint32_t level = 1; level < HL_LEVEL_COUNT; ++level) {
        const hl_level coarser = hair_.describeLevel(level), finer = hair_.describeLevel(level - 1);
        EXPECT_GE(coarser.error_head, finer.error_head);
        EXPECT_GT(coarser.error_wind, 0);
    }
    // An asset that does not say them is measured when it is made: the same numbers.
    std::vector<std::byte> unsaid = bytes_;
    const auto asset = runtime::Asset::open(unsaid);
    const auto sections = asset.asset->sections();
    for (const char* kind : {"LVLE", "LVLS"}) {
        const auto found = std::find_if(sections.begin(), sections.end(),
                                        [&](const auto& section) { return section.kind == kind; });
        ASSERT_NE(found, sections.end());
        const std::size_t record = 64 + 32 * static_cast<std::size_t>(found - sections.begin());
        std::memcpy(&unsaid[record], kind[3] == 'E' ? "XXXE" : "XXXS", 4);
    }
    const auto sum = [&](std::size_t at, std::size_t from, std::size_t size) {
        const std::uint32_t checksum = runtime::asset::checksum(std::span(unsaid).subspan(from, size));
        std::memcpy(&unsaid[at], &checksum, 4);
    };
    sum(28, 64, 32 * sections.size());
    sum(60, 0, 60);
    Asset other;
    ASSERT_TRUE(other.open(unsaid.data(), unsaid.size(), &error_)) << error_.what();
    EXPECT_EQ(other.describe().measured_levels, 0u);
    Instance slow;
    ASSERT_TRUE(slow.make(other, HL_LEVELS));
    for (std::uint32_t level = 0; level < HL_LEVEL_COUNT; ++level) {
        EXPECT_EQ(slow.describeLevel(level).error_wind, hair_.describeLevel(level).error_wind);
        EXPECT_EQ(slow.describeLevel(level).error_still, hair_.describeLevel(level).error_still);
        EXPECT_EQ(slow.describeLevel(level).seen_wind, slow.describeLevel(level).error_wind)
            << "nobody looked at it from afar";
    }
}

TEST_F(RuntimeVersions, TheSpeedOfAMachineFollowsItsClock) {
    open(decorated());
    make(HL_HAIRS | HL_LEVELS);
    // A clock that ticks a tenth of a millisecond at a time: each frame takes one tick.
    std::uint64_t time = 0;
    const auto tick = [](void* user) { return *static_cast<std::uint64_t*>(user) += 100'000; };
    float slow = 0, fast = 0;
    ASSERT_EQ(hl_rate(hair_.get(), tick, &time, &fast, &error_), HL_OK) << error_.what();
    const auto slowTick = [](void* user) { return *static_cast<std::uint64_t*>(user) += 200'000; };
    ASSERT_EQ(hl_rate(hair_.get(), slowTick, &time, &slow, &error_), HL_OK);
    EXPECT_FLOAT_EQ(fast, 2 * slow);
    double predicted = 0;
    for (std::uint32_t level = 0; level < HL_LEVEL_RIGID; ++level)
        predicted += static_cast<double>(hair_.describeLevel(level).milliseconds);
    EXPECT_NEAR(fast, predicted / 0.4, 1e-4 * predicted);
    const auto stopped = [](void*) { return std::uint64_t{5}; };
    EXPECT_EQ(hl_rate(hair_.get(), stopped, nullptr, &fast, &error_), HL_BAD_VALUE);
    EXPECT_THAT(error_.words, HasSubstr("stands still"));
}

}  // namespace
}  // namespace hairloom::test
