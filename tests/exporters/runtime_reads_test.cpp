// SPDX-License-Identifier: GPL-3.0-or-later
// What engines ask hairloom.h for beside positions: attributes, what each hair is, numbers of 16 bits, motion
// vectors, saved states, structs of other versions.

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>

#include "tests/exporters/decorated_sample.h"

namespace hairloom::test {
namespace {

using game::Frame;
using testing::HasSubstr;

/// IEEE 754: sign, five bits of exponent, ten of the rest.
double ofHalf(std::uint16_t half) {
    const int exponent = (half >> 10) & 31, rest = half & 1023;
    const double size = exponent == 0    ? std::ldexp(rest, -24)
                        : exponent == 31 ? std::numeric_limits<double>::infinity()
                                         : std::ldexp(1024 + rest, exponent - 25);
    return (half & 0x8000) != 0 ? -size : size;
}

TEST_F(RuntimeReads, AttributesOfStrandsHaveTheirNamesAndValues) {
    const Groom groom = decorated();
    open(groom);
    std::map<std::string, hl_attribute> found;
    for (std::uint32_t a = 0; a < info_.attributes; ++a) {
        hl_attribute attribute{};
        attribute.size = sizeof attribute;
        ASSERT_EQ(hl_asset_attribute(asset_.get(), a, &attribute, &error_), HL_OK);
        found[std::string(attribute.name, attribute.name_bytes)] = attribute;
        std::uint32_t number = 99;
        ASSERT_EQ(
            hl_asset_find_attribute(asset_.get(), std::string(attribute.name, attribute.name_bytes).c_str(),
                                    &number, &error_),
            HL_OK);
        EXPECT_EQ(number, a);
    }
    ASSERT_EQ(found.count("root_uv") + found.count("colour") + found.count("age"), 3u);
    EXPECT_EQ(found["root_uv"].components, 2u);
    EXPECT_EQ(found["age"].type, static_cast<std::uint32_t>(HL_INT32));
    EXPECT_EQ(found["age"].bytes, groom.strandCount() * 4);
    const auto* ages = static_cast<const std::int32_t*>(found["age"].values);
    const auto* colours = static_cast<const float*>(found["colour"].values);
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        EXPECT_EQ(ages[s], static_cast<std::int32_t>(s) - 3);
        EXPECT_EQ(colours[3 * s + 1], 0.25f);
    }
    std::uint32_t number = 0;
    EXPECT_EQ(hl_asset_find_attribute(asset_.get(), "nobody", &number, &error_), HL_BAD_VALUE);
    EXPECT_THAT(error_.words, HasSubstr("'nobody'"));
    hl_attribute none{};
    none.size = sizeof none;
    EXPECT_EQ(hl_asset_attribute(asset_.get(), info_.attributes, &none, &error_), HL_BAD_VALUE);
    // The same groom comes back from the file.
    const auto back = importStrands(folder / "a.hairrt");
    ASSERT_TRUE(back);
    const auto agesBack = back->groom.strandAttributes.view<std::int32_t>("age");
    ASSERT_EQ(agesBack.size(), groom.strandCount());
    EXPECT_EQ(agesBack[7], 4);
}

TEST_F(RuntimeReads, SettingsAreListedWithNumbersChoicesAndCurves) {
    open(decorated());
    ASSERT_GT(info_.settings, 40u);
    std::map<std::uint32_t, int> kinds;
    for (std::uint32_t s = 0; s < info_.settings; ++s) {
        hl_setting setting{};
        setting.size = sizeof setting;
        ASSERT_EQ(hl_asset_setting(asset_.get(), s, &setting, &error_), HL_OK);
        ++kinds[setting.kind];
        EXPECT_EQ(setting.kind == HL_CHOICE, setting.choice != nullptr);
        EXPECT_EQ(setting.kind == HL_CHOICE, setting.values == nullptr);
    }
    for (const std::uint32_t kind : {HL_NUMBERS, HL_CHOICE, HL_SEED, HL_CURVE})
        EXPECT_GT(kinds[kind], 0) << kind;
    std::uint32_t model = 0;
    ASSERT_EQ(hl_asset_find_setting(asset_.get(), "simulation.strandModel", &model, &error_), HL_OK);
    hl_setting setting{};
    setting.size = sizeof setting;
    ASSERT_EQ(hl_asset_setting(asset_.get(), model, &setting, &error_), HL_OK);
    EXPECT_EQ(std::string(setting.choice, setting.choice_bytes), "rods");
    EXPECT_EQ(hl_asset_find_setting(asset_.get(), "simulation.nothing", &model, &error_), HL_BAD_VALUE);
}

TEST_F(RuntimeReads, WhatAHairIsStaysWhateverShareIsRead) {
    open(decorated());
    make(HL_HAIRS | HL_LEVELS);
    std::vector<hl_hair> hairs(info_.hairs);
    ASSERT_EQ(hl_asset_hairs(asset_.get(), hairs.data(), sizeof(hl_hair), hairs.size(), &error_), HL_OK);
    double sum = 0;
    std::vector<std::uint32_t> layers(info_.guides);
    std::uint32_t layerCount = 0;
    ASSERT_EQ(hl_asset_layers(asset_.get(), &layerCount, layers.data(), layers.size(), nullptr), HL_OK);
    for (const hl_hair& hair : hairs) {
        sum += static_cast<double>(hair.random);
        EXPECT_TRUE(hair.random >= 0 && hair.random < 1);
        EXPECT_NEAR(hair.shares[0] + hair.shares[1] + hair.shares[2], 1, 1e-5);
        EXPECT_EQ(hair.layer, layers[hair.guide]);
        EXPECT_EQ(hair.guide, hair.guides[0]);
        EXPECT_NEAR(hair.colour[1], 0.25f, 1e-5f) << "all guides have it";
        EXPECT_NEAR(hair.root_uv[1], 0.5f, 1e-5f);
        EXPECT_NEAR(hair.root_uv[0], static_cast<float>(hair.guide) / static_cast<float>(info_.guides),
                    0.25f);
        EXPECT_GT(hair.root_radius, hair.tip_radius);
    }
    EXPECT_NEAR(sum / static_cast<double>(hairs.size()), 0.5, 0.1);
    step(hair_, 1);
    std::vector<float> all, some;
    ASSERT_TRUE(hair_.readHairs(all));
    const std::size_t floats = 3 * info_.points_per_hair;
    ASSERT_TRUE(hair_.setLevel(HL_LEVEL_FINEST, 0.4f));
    ASSERT_TRUE(hair_.readHairs(some));
    std::vector<std::uint32_t> numbers(hair_.describe().hairs);
    ASSERT_LT(numbers.size(), hairs.size());
    ASSERT_EQ(hl_instance_hair_numbers(hair_.get(), numbers.data(), numbers.size(), &error_), HL_OK);
    for (std::size_t h = 0; h < numbers.size(); ++h)
        EXPECT_EQ(std::memcmp(&some[h * floats], &all[numbers[h] * floats], floats * sizeof(float)), 0) << h;
    EXPECT_EQ(hl_instance_hair_numbers(hair_.get(), numbers.data(), numbers.size() - 1, &error_),
              HL_WRONG_SIZE);
    EXPECT_EQ(hl_asset_hairs(asset_.get(), hairs.data(), sizeof(hl_hair), 3, &error_), HL_WRONG_SIZE);
    EXPECT_EQ(hl_asset_hairs(asset_.get(), hairs.data(), 5, hairs.size(), &error_), HL_WRONG_SIZE);
}

TEST_F(RuntimeReads, OnePassGivesWhatSeveralGiveInEveryFormat) {
    open(decorated());
    make(HL_HAIRS);
    for (int f = 1; f <= 5; ++f) step(hair_, f);
    for (const bool hairs : {false, true}) {
        const std::size_t count = points(hairs);
        std::vector<float> positions(3 * count), tangents(3 * count), radii(count);
        const auto plain = hairs ? hl_instance_read_hairs : hl_instance_read_guides;
        ASSERT_EQ(plain(hair_.get(), game::tight(positions, 3), game::tight(tangents, 3),
                        game::tight(radii, 1), nullptr),
                  HL_OK);
        hl_read read;
        hl_read_init(&read);
        read.hairs = hairs;
        struct Vertex {
            std::uint16_t position[3], tangent[3], radius, unused;
        };
        for (const std::uint32_t format : {HL_FLOAT16, HL_NORM16}) {
            std::vector<Vertex> vertices(count, Vertex{{}, {}, 0, 0xabcd});
            const std::size_t bytes = count * sizeof(Vertex);
            read.state = 0;
            read.position_format = read.tangent_format = read.radius_format = format;
            read.positions = {vertices[0].position, bytes, sizeof(Vertex)};
            read.tangents = {vertices[0].tangent, bytes - 6, sizeof(Vertex)};
            read.radii = {&vertices[0].radius, bytes - 12, sizeof(Vertex)};
            const float from[3] = {-0.5f, 1.0f, -0.5f}, to[3] = {0.5f, 2.0f, 0.5f};
            std::copy_n(from, 3, read.from);
            std::copy_n(to, 3, read.to);
            ASSERT_EQ(hl_instance_read(hair_.get(), &read, &error_), HL_OK) << error_.what();
            EXPECT_EQ(read.outside, 0u);
            float low = 9, high = -9;
            for (std::size_t p = 0; p < count; ++p) {
                const Vertex& vertex = vertices[p];
                for (std::size_t c = 0; c < 3; ++c) {
                    const bool half = format == HL_FLOAT16;
                    const double at = half ? ofHalf(vertex.position[c]) + static_cast<double>(from[c])
                                           : vertex.position[c] / 65535.0 + static_cast<double>(from[c]);
                    ASSERT_NEAR(at, positions[3 * p + c], half ? 2.5e-4 : 0.8e-5);
                    const auto norm = static_cast<std::int16_t>(vertex.tangent[c]);
                    ASSERT_NEAR(half ? ofHalf(vertex.tangent[c]) : norm / 32767.0, tangents[3 * p + c],
                                half ? 5e-4 : 2e-5);
                }
                low = std::min(low, positions[3 * p]);
                high = std::max(high, positions[3 * p]);
                const double radius =
                    format == HL_FLOAT16 ? ofHalf(vertex.radius) : vertex.radius / 65535.0 * 1e-3;
                ASSERT_NEAR(radius, radii[p], 2e-8 + 1e-3 * static_cast<double>(radii[p]));
                ASSERT_EQ(vertex.unused, 0xabcd);
            }
            EXPECT_EQ(read.bounds_min[0], low);
            EXPECT_EQ(read.bounds_max[0], high);
        }
    }
}

TEST_F(RuntimeReads, HalvesAreThoseOfIeee754) {
    open(decorated());
    make(HL_GUIDES);
    // Positions go through one function: each root is put where the value is that is looked at.
    std::vector<float> roots(7 * std::size_t{info_.guides});
    const std::vector<std::pair<float, std::uint16_t>> cases{{0, 0},
                                                             {1, 0x3c00},
                                                             {-2, 0xc000},
                                                             {65504, 0x7bff},
                                                             {65519.9f, 0x7bff},
                                                             {65520, 0x7c00},
                                                             {0x1p-14f, 0x0400},
                                                             {0x1p-24f, 1},
                                                             {0x1p-25f, 0},
                                                             {0x1.8p-25f, 1},
                                                             {1.5f, 0x3e00},
                                                             {0x1.002p0f, 0x3c00},
                                                             {0x1.006p0f, 0x3c02},
                                                             {-0x1.ff8p-15f, 0x83ff}};
    ASSERT_GE(info_.guides, cases.size());
    for (std::size_t g = 0; g < info_.guides; ++g) {
        roots[7 * g] = cases[g % cases.size()].first;
        roots[7 * g + 6] = 1;
    }
    Frame frame;
    frame.roots = roots.data();
    frame.root_count = info_.guides;
    ASSERT_TRUE(hair_.reset(frame));
    std::vector<std::uint32_t> offsets(info_.guides + 1);
    ASSERT_EQ(hl_instance_offsets(hair_.get(), offsets.data(), offsets.size(), nullptr), HL_OK);
    std::vector<std::uint16_t> halves(3 * points(false));
    hl_read read;
    hl_read_init(&read);
    read.position_format = HL_FLOAT16;
    read.positions = {halves.data(), halves.size() * 2, 6};
    ASSERT_EQ(hl_instance_read(hair_.get(), &read, &error_), HL_OK);
    for (std::size_t g = 0; g < info_.guides; ++g)
        EXPECT_EQ(halves[3 * offsets[g]], cases[g % cases.size()].second) << cases[g % cases.size()].first;
}

TEST_F(RuntimeReads, PreviousPositionsAreThoseOfTheLastRead) {
    open(decorated());
    make(HL_HAIRS | HL_LEVELS);
    std::vector<float> now(3 * points()), before(3 * points()), last;
    hl_read read;
    hl_read_init(&read);
    read.hairs = 1;
    read.positions = game::tight(now, 3);
    read.previous = game::tight(before, 3);
    for (int f = 1; f <= 4; ++f) {
        step(hair_, f);
        ASSERT_EQ(hl_instance_read(hair_.get(), &read, &error_), HL_OK);
        EXPECT_EQ(read.changed, 1u);
        EXPECT_EQ(before, f == 1 ? now : last);
        last = now;
        if (f > 1) continue;
        // At the first they are where they are now, so nothing is new until the next step.
        ASSERT_EQ(hl_instance_read(hair_.get(), &read, &error_), HL_OK);
        EXPECT_EQ(read.changed, 0u);
    }
    // Once more without a step: what moved has stopped. Then nothing is new.
    ASSERT_EQ(hl_instance_read(hair_.get(), &read, &error_), HL_OK);
    EXPECT_EQ(read.changed, 1u);
    EXPECT_EQ(before, now);
    std::fill(now.begin(), now.end(), 5.0f);
    ASSERT_EQ(hl_instance_read(hair_.get(), &read, &error_), HL_OK);
    EXPECT_EQ(read.changed, 0u);
    EXPECT_EQ(now[0], 5.0f) << "nothing is written";
    EXPECT_LT(read.bounds_min[1], read.bounds_max[1]) << "bounds are known all the same";
    // Measured from another origin.
    std::array<float, 12> head{1, 0, 0, 0.04f - 100, 0, 1, 0, 0, 0, 0, 1, 0};
    Frame frame;
    frame.time = 5 / 60.0;
    frame.head = head.data();
    frame.origin[0] = 100;
    ASSERT_TRUE(hair_.step(frame));
    ASSERT_EQ(hl_instance_read(hair_.get(), &read, &error_), HL_OK);
    for (std::size_t i = 0; i < last.size(); i += 3) ASSERT_NEAR(before[i], last[i] - 100, 1e-5);
    // Another share: nobody knows where these were.
    ASSERT_TRUE(hair_.setLevel(HL_LEVEL_FINEST, 0.5f));
    ASSERT_EQ(hl_instance_read(hair_.get(), &read, &error_), HL_OK);
    for (std::size_t i = 0; i < 3 * points(); ++i) ASSERT_EQ(before[i], now[i]);
}

TEST_F(RuntimeReads, WhatCannotBeReadIsRefusedAndNothingWritten) {
    open(decorated());
    make(HL_GUIDES);
    std::vector<float> values(3 * points(false), 7.0f);
    const auto refused = [&](hl_code code, const char* words, const auto& spoil) {
        hl_read read;
        hl_read_init(&read);
        read.positions = game::tight(values, 3);
        read.to[0] = read.to[1] = read.to[2] = 1;
        spoil(read);
        const std::vector<float> before = values;
        EXPECT_EQ(hl_instance_read(hair_.get(), &read, &error_), code) << words;
        EXPECT_THAT(error_.words, HasSubstr(words));
        EXPECT_EQ(values, before);
    };
    refused(HL_BAD_VALUE, "without follow hairs", [](hl_read& read) { read.hairs = 1; });
    refused(HL_BAD_VALUE, "format 3", [](hl_read& read) { read.radius_format = 3; });
    refused(HL_WRONG_SIZE, "positions", [](hl_read& read) { read.positions.bytes -= 1; });
    refused(HL_WRONG_SIZE, "stride of positions", [](hl_read& read) { read.positions.stride = 8; });
    refused(HL_WRONG_SIZE, "previous", [&](hl_read& read) { read.previous = {values.data(), 12, 12}; });
    refused(HL_BAD_VALUE, "box", [](hl_read& read) {
        read.position_format = HL_NORM16;
        read.to[1] = read.from[1];
    });
    refused(HL_BAD_VALUE, "box", [](hl_read& read) {
        read.position_format = HL_FLOAT16;
        read.from[1] = std::numeric_limits<float>::quiet_NaN();
    });
    refused(HL_WRONG_SIZE, "bytes of hl_read", [](hl_read& read) { read.size = 3; });
    EXPECT_EQ(hl_instance_read(hair_.get(), nullptr, &error_), HL_BAD_VALUE);
    EXPECT_EQ(hl_instance_read(nullptr, nullptr, &error_), HL_BAD_VALUE);
}

TEST_F(RuntimeReads, ChoicesAreReplacedByName) {
    open(decorated());
    make(HL_GUIDES);
    game::Instance other;
    ASSERT_TRUE(other.make(asset_, HL_GUIDES));
    EXPECT_FALSE(hair_.choose("strandModel", "ropes", &error_));
    EXPECT_STREQ(error_.words, "setting 'strandModel' is 'ropes'; expected one of rods, springs");
    EXPECT_FALSE(hair_.choose("windSpeed", "springs", &error_));
    EXPECT_STREQ(error_.words, "setting 'windSpeed' is no choice");
    EXPECT_FALSE(hair_.choose("nothing", "springs", &error_));
    EXPECT_STREQ(error_.words, "setting 'nothing' does not exist");
    ASSERT_TRUE(hair_.choose("strandModel", "springs", &error_)) << error_.what();
    ASSERT_TRUE(other.set("strandModel", 1));
    for (int frame = 1; frame <= 5; ++frame) {
        step(hair_, frame);
        step(other, frame);
    }
    EXPECT_EQ(hair_.hash(), other.hash());
    game::Instance rods;
    ASSERT_TRUE(rods.make(asset_, HL_GUIDES));
    for (int frame = 1; frame <= 5; ++frame) step(rods, frame);
    EXPECT_NE(hair_.hash(), rods.hash());
}

}  // namespace
}  // namespace hairloom::test
