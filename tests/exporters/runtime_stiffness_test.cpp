// SPDX-License-Identifier: GPL-3.0-or-later
// Stiffness by region in the runtime asset: what games play is what the project plays.

#include <gmock/gmock.h>

#include <cstring>
#include <limits>

#include "core/simulation/scene_input.h"
#include "tests/exporters/posed_hair.h"

namespace hairloom::test {
namespace {

namespace format = runtime::asset;
using testing::HasSubstr;

/// Level hair of one stiffness on a half of the head and another on the other.
Groom halfStiff(float soft = 0.25f, float stiff = 8) {
    Groom groom = dome(6, 1, 14, 0.16f);
    groom.simulation.strandModel = runtime::StrandModel::rods;
    groom.simulation.restGravity = 0;
    groom.simulation.sleepSpeed = 0;
    std::vector<float> stiffness;
    for (std::size_t s = 0; s < groom.strandCount(); ++s)
        stiffness.push_back(groom.strand(s)[0].x() < 0 ? soft : stiff);
    groom.strandAttributes.set(attribute::kStiffness, std::move(stiffness));
    return groom;
}

class RuntimeStiffness : public RuntimePoses {
  protected:
    /// How far it stands from hair whose strands are all alike, mm: the mean of tips, of the soft half and of
    /// the stiff one.
    std::array<double, 2> tipsFrom(const std::vector<Vec3f>& points, const std::vector<Vec3f>& even,
                                   const Groom& groom) {
        std::array<double, 2> sums{}, counts{};
        for (std::size_t s = 0; s < groom.strandCount(); ++s) {
            const std::size_t half = groom.strand(s)[0].x() < 0 ? 0 : 1, tip = groom.offsets[s + 1] - 1;
            sums[half] += 1e3 * static_cast<double>((points[tip] - even[tip]).norm());
            ++counts[half];
        }
        return {sums[0] / counts[0], sums[1] / counts[1]};
    }
};

TEST_F(RuntimeStiffness, AGamePlaysWhatTheProjectPlays) {
    const Groom groom = halfStiff();
    open(groom);
    EXPECT_EQ(asset_.describe().minor, 6u);
    const auto opened = runtime::Asset::open(bytes_);
    const auto kept = opened.asset->strandStiffness();
    const auto authored = groom.strandAttributes.view<float>(attribute::kStiffness);
    ASSERT_TRUE(std::ranges::equal(kept, authored));
    play(hair_, 1, 40);
    const std::vector<Vec3f> played = guides(hair_);

    Groom even = groom;
    even.strandAttributes.erase(attribute::kStiffness);
    open(even);
    EXPECT_EQ(asset_.describe().minor, 2u) << "files without are as before";
    play(hair_, 1, 40);
    const auto apart = tipsFrom(played, guides(hair_), groom);
    EXPECT_GT(apart[0], 3) << "softer";
    EXPECT_GT(apart[1], 3) << "stiffer";

    // The same settings for all: each half is where it is in hair that is alike everywhere.
    for (const auto& [half, factor] : {std::pair<std::size_t, float>(0, 0.25f), {1, 8}}) {
        Groom alike = groom;
        alike.strandAttributes.set(attribute::kStiffness, std::vector<float>(groom.strandCount(), factor));
        open(alike);
        play(hair_, 1, 40);
        EXPECT_EQ(tipsFrom(played, guides(hair_), groom)[half], 0) << factor;
    }
}

TEST_F(RuntimeStiffness, CoarserLevelsHaveThatOfTheirGuides) {
    const Groom groom = halfStiff(0.1f, 30);
    Groom even = groom;
    even.strandAttributes.erase(attribute::kStiffness);
    for (std::uint32_t level = 1; level < HL_LEVEL_RIGID; ++level) {
        const auto playedAt = [&](const Groom& which) {
            open(which, HL_GUIDES | HL_LEVELS);
            EXPECT_EQ(hl_instance_set_level(hair_.get(), level, 1, nullptr), HL_OK);
            play(hair_, 1, 60);
            return guides(hair_);
        };
        const auto apart = tipsFrom(playedAt(groom), playedAt(even), groom);
        EXPECT_GT(apart[0], 2) << "softer, level " << level;
        EXPECT_GT(apart[1], 2) << "stiffer, level " << level;
    }
}

TEST_F(RuntimeStiffness, ReadsBackIntoAProject) {
    const Groom groom = halfStiff();
    ExportReport report;
    open(groom, HL_GUIDES, &report);
    const auto row = std::ranges::find(report.attributes, "stiffness", &ComparedAttribute::name);
    ASSERT_NE(row, report.attributes.end());
    EXPECT_EQ(row->maxError, 0);
}

TEST_F(RuntimeStiffness, WhatIsNoneIsRefusedWithItsPlace) {
    const auto bytes = written(halfStiff());
    const auto valuesAt = [](AssetBytes& copy) {
        const auto asset = *runtime::Asset::open(copy.span()).asset;
        const auto* const attribute = asset.findAttribute(format::kStiffnessName);
        return reinterpret_cast<float*>(const_cast<std::byte*>(asset.valuesOf(*attribute).data()));
    };
    for (const auto& [value, words] : {std::pair(-1.0f, "-1"), std::pair(1001.0f, "1001"),
                                       std::pair(std::numeric_limits<float>::quiet_NaN(), "nan")}) {
        AssetBytes copy(bytes);
        valuesAt(copy)[3] = value;
        copy.seal();
        const auto opened = runtime::Asset::open(copy.span());
        const auto problem = opened.asset->check();
        ASSERT_TRUE(problem) << words;
        EXPECT_THAT(problem->words, HasSubstr("stiffness of strand 3 that is " + std::string(words)));
        EXPECT_THAT(problem->words, HasSubstr("expected 0 to 1000"));
        EXPECT_EQ(problem->byte, static_cast<std::uint64_t>(reinterpret_cast<std::byte*>(valuesAt(copy) + 3) -
                                                            copy.span().data()));
        // Before version 1.6 the name meant nothing.
        copy.header().minor = 5;
        copy.seal();
        const auto older = runtime::Asset::open(copy.span());
        EXPECT_FALSE(older.asset->check()) << words;
        EXPECT_TRUE(older.asset->strandStiffness().empty());
    }
    AssetBytes copy(bytes);
    const auto asset = *runtime::Asset::open(copy.span()).asset;
    const_cast<format::Attribute*>(asset.findAttribute(format::kStiffnessName))->type =
        format::AttributeType::int32;
    copy.seal();
    const auto problem = runtime::Asset::open(copy.span()).asset->check();
    ASSERT_TRUE(problem);
    EXPECT_THAT(problem->words, HasSubstr("not one float32 of each strand"));
}

TEST_F(RuntimeStiffness, OfAnotherTypeIsAnAttributeAsAnyOther) {
    Groom groom = halfStiff();
    groom.strandAttributes.set(attribute::kStiffness,
                               std::vector<std::uint32_t>(groom.strandCount(), 70'000));
    const auto bytes = written(groom);
    const auto opened = runtime::Asset::open(bytes);
    EXPECT_EQ(opened.asset->minor(), 2u);
    EXPECT_FALSE(opened.asset->check());
    EXPECT_TRUE(opened.asset->findAttribute("stiffness"));
    EXPECT_TRUE(opened.asset->strandStiffness().empty());
    EXPECT_FALSE(SceneInput::make(groom)) << "a project says what is wrong";
}

}  // namespace
}  // namespace hairloom::test
