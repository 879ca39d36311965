// SPDX-License-Identifier: GPL-3.0-or-later
// Memory that is asked for ahead of time: nothing is asked for afterwards, and nothing else changes.

#include <gmock/gmock.h>

#include "core/groom/groom.h"
#include "tests/exporters/levels_sample.h"
#include "tests/runtime/allocations.h"

namespace hairloom::test {
namespace {

using game::Error;
using game::Instance;
using testing::HasSubstr;

constexpr std::uint32_t kSpheres = 40;

/// Spheres of a body that come and go: none, all of them in the hair, a few far off.
struct Company {
    std::vector<float> values;
    explicit Company(int f) {
        const std::uint32_t count = f % 3 == 0 ? 0 : f % 3 == 1 ? kSpheres : 3;
        for (std::uint32_t s = 0; s < count; ++s) {
            const float far = count == 3 ? 50.0f : 0.0f;
            const auto at = static_cast<float>(s);
            values.insert(values.end(), {0.05f * std::sin(at) + far, 1.7f + 0.002f * at, 0.05f * std::cos(at),
                                         0.02f + 0.001f * static_cast<float>(f % 5)});
        }
    }
    void join(hl_frame& frame) const {
        frame.spheres = values.empty() ? &kPlace : values.data();
        frame.sphere_count = values.size() / 4;
    }
    static constexpr float kPlace = 0;
};

class RuntimeReserve : public RuntimeLevels {
  protected:
    /// How often memory is asked for in frames that do all that frames may do.
    std::size_t allocationsOf(Instance& hair, int frames = 60) {
        const hl_instance_info info = hair.describe();
        std::vector<Vec3f> points(info.guide_points), before(info.guide_points);
        std::vector<Vec3f> hairs(std::size_t{info.hairs} * info.points_per_hair), hairsBefore(hairs.size());
        const auto out = [](std::vector<Vec3f>& to) {
            return to.empty() ? game::kNothing : hl_out{to.data(), to.size() * 12, 12};
        };
        std::size_t asked = 0;
        for (int f = 1; f <= frames; ++f) {
            Walk walk(f);
            const Company company(f);
            company.join(walk.frame);
            if (f % 4 == 0) walk.frame.wind = nullptr;
            const std::size_t from = runtime::allocationCount();
            if (f % 7 == 0) {
                EXPECT_TRUE(hair.setLevel(static_cast<std::uint32_t>(f / 7) % HL_LEVEL_COUNT));
            }
            if (f % 31 == 0) {
                EXPECT_TRUE(hair.reset(walk.frame));
            }
            EXPECT_TRUE(hair.step(walk.frame));
            hl_read read;
            hl_read_init(&read);
            read.positions = out(points);
            read.previous = out(before);
            EXPECT_EQ(hl_instance_read(hair.get(), &read, nullptr), HL_OK);
            read.hairs = 1;
            read.positions = out(hairs);
            read.previous = out(hairsBefore);
            if (!hairs.empty()) {
                EXPECT_EQ(hl_instance_read(hair.get(), &read, nullptr), HL_OK);
            }
            asked += runtime::allocationCount() - from;
        }
        return asked;
    }
    static hl_reserve wanted() {
        hl_reserve wanted;
        hl_reserve_init(&wanted);
        wanted.spheres = kSpheres;
        wanted.previous_guides = wanted.previous_hairs = 1;
        return wanted;
    }
};

TEST_F(RuntimeReserve, NoFrameAsksForMemoryAfterwards) {
    for (const auto model : {runtime::StrandModel::rods, runtime::StrandModel::springs}) {
        Groom groom = hair();
        groom.simulation.strandModel = model;
        bytes_ = written(groom);
        ASSERT_TRUE(asset_.open(bytes_.data(), bytes_.size()));
        Instance without, with;
        ASSERT_TRUE(without.make(asset_, HL_HAIRS | HL_LEVELS));
        ASSERT_TRUE(with.make(asset_, HL_HAIRS | HL_LEVELS));
        const hl_reserve reserve = wanted();
        Error error;
        ASSERT_EQ(hl_instance_reserve(with.get(), &reserve, &error), HL_OK) << error.what();
        EXPECT_EQ(with.hash(), without.hash());
        EXPECT_EQ(allocationsOf(with), 0u) << "model " << static_cast<int>(model);
        EXPECT_GT(allocationsOf(without), 0u) << "else this test looks at nothing";
        EXPECT_EQ(with.hash(), without.hash()) << "the same frames, the same bits";
        EXPECT_EQ(guides(with), guides(without));
    }
}

TEST_F(RuntimeReserve, AMovingSleepingOrCoarserInstanceGoesOnAsItWas) {
    const hl_reserve reserve = wanted();
    for (const std::uint32_t level : {0u, 2u, 4u}) {
        Instance one = another(), two = another();
        for (Instance* hair : {&one, &two}) ASSERT_TRUE(hair->setLevel(level));
        const auto both = [&](int f, float still) {
            for (Instance* hair : {&one, &two}) ASSERT_TRUE(hair->step(Walk(f, 0, still).frame));
            ASSERT_EQ(one.hash(), two.hash()) << level << " " << f;
        };
        for (int f = 1; f <= 20; ++f) both(f, 1);
        std::vector<Vec3f> seen(one.describe().guide_points);
        hl_read read;
        hl_read_init(&read);
        read.positions = {seen.data(), seen.size() * 12, 12};
        ASSERT_EQ(hl_instance_read(two.get(), &read, nullptr), HL_OK);
        ASSERT_EQ(hl_instance_reserve(two.get(), &reserve, nullptr), HL_OK);
        ASSERT_EQ(hl_instance_read(two.get(), &read, nullptr), HL_OK);
        EXPECT_EQ(read.changed, 0u) << "what was read is still so";
        EXPECT_EQ(one.hash(), two.hash());
        EXPECT_EQ(guides(one), guides(two));
        for (int f = 21; f <= 40; ++f) both(f, 1);
        for (int f = 0; f < 400; ++f) both(0, 0);
        EXPECT_EQ(two.describe().asleep, two.describe().guides);
        ASSERT_EQ(hl_instance_reserve(two.get(), &reserve, nullptr), HL_OK);
        EXPECT_EQ(two.describe().asleep, two.describe().guides);
        for (int f = 41; f <= 50; ++f) both(f, 1);
    }
}

TEST_F(RuntimeReserve, WhatCannotBeReservedIsRefused) {
    Error error;
    hl_reserve reserve = wanted();
    const std::uint64_t before = first_.hash();
    const auto refused = [&](hl_code code, const char* words) {
        EXPECT_EQ(hl_instance_reserve(first_.get(), &reserve, &error), code) << words;
        EXPECT_THAT(error.words, HasSubstr(words));
        reserve = wanted();
    };
    for (const std::size_t garbage : {std::size_t{0}, std::size_t{20}, ~std::size_t{0}}) {
        reserve.size = garbage;
        refused(HL_WRONG_SIZE, "hl_reserve");
    }
    reserve.spheres = 4097;
    refused(HL_BAD_VALUE, "4097");
    reserve.previous_hairs = 2;
    refused(HL_BAD_VALUE, "previous_hairs");
    EXPECT_EQ(hl_instance_reserve(first_.get(), nullptr, &error), HL_BAD_VALUE);
    EXPECT_EQ(hl_instance_reserve(nullptr, &reserve, &error), HL_BAD_VALUE);
    EXPECT_EQ(first_.hash(), before);
    reserve.spheres = 0;
    EXPECT_EQ(hl_instance_reserve(first_.get(), &reserve, &error), HL_OK) << error.what();
}

}  // namespace
}  // namespace hairloom::test
