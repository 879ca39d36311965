// SPDX-License-Identifier: GPL-3.0-or-later
// Poses in the runtime asset.

#include <gmock/gmock.h>

#include <algorithm>
#include <random>
#include <set>

#include "runtime/asset/pose_directions.h"
#include "tests/exporters/posed_hair.h"
#include "tests/support/source_dir.h"

namespace hairloom::test {
namespace {

using game::Error;
using game::Instance;
using testing::HasSubstr;

TEST(PoseDirections, AreWithinTheStatedErrorAndOfLengthOne) {
    std::mt19937 random(5);
    std::normal_distribution<float> normal;
    float largest = 0;
    const auto look = [&](Vec3f at) {
        const Vec3f d = at.normalized();
        const auto read = runtime::directionOf(runtime::packedDirection({d.x(), d.y(), d.z()}));
        const Vec3f back(read.x, read.y, read.z);
        EXPECT_NEAR(back.norm(), 1, 1e-6f);
        largest = std::max(largest, 2 * std::asin(0.5f * (back - d).norm()));
    };
    for (int i = 0; i < 200'000; ++i) look({normal(random), normal(random), normal(random)});
    for (int axis = 0; axis < 3; ++axis) {
        look(Vec3f::Unit(axis));
        look(-Vec3f::Unit(axis));
        look(Vec3f(1, 1, 1) - Vec3f::Unit(axis));
    }
    EXPECT_LE(largest, runtime::asset::kPoseDirectionError);
    EXPECT_GT(largest, 0.5f * runtime::asset::kPoseDirectionError) << "the stated error is that of the bits";
    // Whatever bits there are, they are a direction.
    for (int i = 0; i < 20'000; ++i) {
        const auto bits = static_cast<std::uint32_t>(random());
        const auto read = runtime::directionOf(
            {static_cast<std::int16_t>(bits & 0xffffu), static_cast<std::int16_t>(bits >> 16u)});
        ASSERT_NEAR(runtime::length(read), 1, 1e-6f) << bits;
    }
}

TEST_F(RuntimePoses, GoIntoTheAssetWithNamesAmountsAndWeights) {
    Groom groom = posed();
    groom.poses[0].amount = 0.25f;
    ExportReport report;
    open(groom, HL_GUIDES, &report);
    const hl_asset_info info = asset_.describe();
    EXPECT_EQ(info.minor, 5u);
    ASSERT_EQ(info.poses, 2u);
    const auto poseAt = [&](std::uint32_t k) {
        hl_hair_pose pose{};
        pose.size = sizeof pose;
        EXPECT_EQ(hl_asset_pose(asset_.get(), k, &pose, nullptr), HL_OK);
        return pose;
    };
    EXPECT_EQ(std::string(poseAt(0).name, poseAt(0).name_bytes), "Swept");
    EXPECT_EQ(poseAt(0).amount, 0.25f);
    EXPECT_EQ(poseAt(0).partial, 0u);
    EXPECT_EQ(std::string(poseAt(1).name, poseAt(1).name_bytes), "Wet");
    EXPECT_EQ(poseAt(1).amount, 0);
    EXPECT_EQ(poseAt(1).partial, 1u);
    std::uint32_t found = 9;
    EXPECT_TRUE(asset_.findPose("Wet", found));
    EXPECT_EQ(found, 1u);
    Error error;
    EXPECT_FALSE(asset_.findPose("Dry", found, &error));
    EXPECT_THAT(error.words, HasSubstr("no pose of the name 'Dry'"));
    float amount = -1;
    EXPECT_EQ(hl_instance_pose(hair_.get(), 0, &amount, &error), HL_OK);
    EXPECT_EQ(amount, 0.25f) << "as authored";
    EXPECT_EQ(hl_instance_pose(hair_.get(), 2, &amount, &error), HL_BAD_VALUE);
    EXPECT_THAT(error.words, HasSubstr("pose 2 of 2"));
    EXPECT_FALSE(hair_.setPose(2, 1, &error));
    EXPECT_FALSE(hair_.setPose(0, 1.5f, &error));
    EXPECT_THAT(error.words, HasSubstr("expected 0 to 1"));

    const auto opened = runtime::Asset::open(bytes_);
    const auto read = opened.asset->poseArrays(1, opened.asset->strandsAtRest());
    const std::vector<float> weights = poseWeights(groom, groom.poses[1]);
    ASSERT_EQ(read.weights.size(), weights.size());
    for (std::size_t p = 0; p < weights.size(); ++p)
        ASSERT_NEAR(read.weights[p], weights[p], 0.5f / 255 + 1e-6f);
    EXPECT_TRUE(opened.asset->poseArrays(0, opened.asset->strandsAtRest()).weights.empty());
    const auto error_mm = std::ranges::find(report.attributes, "poses", &ComparedAttribute::name);
    ASSERT_NE(error_mm, report.attributes.end());
    // Directions, of 16 cm, and lengths of segments, which are those of the quantised strands.
    EXPECT_LT(error_mm->maxError, 0.16 * 5e-5 + 14 * 2 * opened.asset->greatestError());
    EXPECT_GT(error_mm->maxError, 1e-7);
    for (const LeftBehind& left : report.leftBehind) EXPECT_THAT(left.what, testing::Not(HasSubstr("poses")));
}

TEST_F(RuntimePoses, OfOtherFormatsAndWithoutAShapeAreSaid) {
    Groom groom = posed();
    const auto path = folder / "a.ply";
    const auto other = strandWriter("ply").write(groom, path, {});
    ASSERT_TRUE(other);
    EXPECT_TRUE(std::ranges::any_of(other->leftBehind, [](const LeftBehind& left) {
        return left.what.find("2 poses") != std::string::npos;
    }));
    groom.pointAttributes.erase(poseAttribute("Swept"));
    groom.simulation.strandModel = runtime::StrandModel::springs;
    ExportReport report;
    open(groom, HL_GUIDES, &report);
    EXPECT_EQ(asset_.describe().poses, 1u);
    const auto said = [&](const char* words) {
        return std::ranges::any_of(report.findings, [&](const Finding& finding) {
            return finding.what.find(words) != std::string::npos;
        });
    };
    EXPECT_TRUE(said("has no shape"));
    EXPECT_TRUE(said("springs follow no pose"));
    ASSERT_TRUE(hair_.setPose(0, 1));
    play(hair_, 1, 4);
    EXPECT_EQ(poseEffect(hair_).on, 0u);
}

TEST_F(RuntimePoses, WithOtherPointsAreTheShapeAndTheRampOfTheGrooms) {
    const Groom groom = posed();
    StrandExportOptions options;
    options.pointsPerStrand = 20;
    const auto bytes = written(groom, nullptr, options);
    const auto opened = runtime::Asset::open(bytes);
    ASSERT_TRUE(opened.asset);
    const auto rest = opened.asset->strandsAtRest();
    const auto read = opened.asset->poseArrays(1, rest);
    const std::vector<float> weights = poseWeights(groom, groom.poses[1]);
    const auto shape = groom.pointAttributes.view<Vec3f>(poseAttribute("Wet"));
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        EXPECT_NEAR(read.weights[rest.offsets[s]], weights[groom.offsets[s]], 0.003f);
        EXPECT_NEAR(read.weights[rest.offsets[s + 1] - 1], weights[groom.offsets[s + 1] - 1], 0.003f);
        const auto& tip = read.positions_ss[rest.offsets[s + 1] - 1];
        const Vec3f expected = shape[groom.offsets[s + 1] - 1] - shape[groom.offsets[s]];
        EXPECT_LT((Vec3f(tip.x, tip.y, tip.z) - expected).norm(), 0.0005f) << "corners are cut";
    }
}

TEST_F(RuntimePoses, AnAssetWithoutHasTheBytesAndTheBitsOfBefore) {
    Groom groom = posed();
    open(groom);
    Groom none = groom;
    none.poses.clear();
    for (const char* name : {"Swept", "Wet"}) none.pointAttributes.erase(poseAttribute(name));
    const auto plain = written(none);
    game::Asset without;
    ASSERT_TRUE(without.open(plain.data(), plain.size()));
    EXPECT_EQ(without.describe().minor, 2u);
    EXPECT_EQ(without.describe().poses, 0u);
    Instance other;
    ASSERT_TRUE(other.make(without, HL_GUIDES));
    play(hair_, 1, 30);
    play(other, 1, 30);
    EXPECT_EQ(hair_.hash(), other.hash()) << "amounts of 0";
    EXPECT_EQ(poseEffect(hair_).on, 0u);
    // 16 bytes of each point and pose: the poses themselves, and padding of blocks.
    const std::size_t more = hair_.describe().bytes - other.describe().bytes;
    EXPECT_GE(more, std::size_t{2} * 16 * hair_.describe().guide_points);
    EXPECT_LE(more, std::size_t{2} * 16 * hair_.describe().guide_points * 3 / 2);
    hl_error error{};
    EXPECT_EQ(hl_instance_set_pose(other.get(), 0, 0, &error), HL_BAD_VALUE);
    EXPECT_THAT(error.words, HasSubstr("pose 0 of 0"));
    // On and off again, it is simulated as hair that never was posed, and needs no more memory.
    const std::size_t before = hair_.describe().bytes;
    ASSERT_TRUE(hair_.setPose(0, 0.5f));
    play(hair_, 30, 34);
    EXPECT_EQ(poseEffect(hair_).on, 1u);
    EXPECT_THAT(std::string(poseEffect(hair_).why), HasSubstr("0.5"));
    EXPECT_GT(hair_.describe().bytes, before);
    EXPECT_LE(hair_.describe().bytes, asset_.describe().guides_memory);
    ASSERT_TRUE(hair_.setPose(0, 0));
    play(hair_, 34, 36);
    EXPECT_EQ(hair_.describe().bytes, before);
}

TEST_F(RuntimePoses, OfDamageAreRefusedWithWordsOrFinite) {
    open(posed());
    namespace format = runtime::asset;
    const auto sectionOf = [](AssetBytes& copy, std::string_view kind) {
        return *std::ranges::find_if(copy.table(), [&](const format::Section& section) {
            return std::string_view(section.kind.data(), 4) == kind;
        });
    };
    const auto refused = [&](const auto& change, const char* words) {
        AssetBytes copy(bytes_);
        change(copy);
        copy.seal();
        const auto opened = runtime::Asset::open(copy.span());
        ASSERT_TRUE(opened.asset) << words;
        const auto problem = opened.asset->check();
        ASSERT_TRUE(problem) << words;
        EXPECT_THAT(problem->words, HasSubstr(words));
    };
    const auto poseIn = [&](AssetBytes& copy, std::size_t k) -> format::Pose& {
        return reinterpret_cast<format::Pose*>(copy.span().data() + sectionOf(copy, "POSE").offset)[k];
    };
    refused([&](AssetBytes& copy) { poseIn(copy, 0).amount = 1.25f; }, "whose amount is not from 0 to 1");
    refused([&](AssetBytes& copy) { poseIn(copy, 1).amount = NAN; }, "whose amount is not from 0 to 1");
    refused([&](AssetBytes& copy) { poseIn(copy, 0).weights = 2; }, "whose weights are not in the file");
    refused([&](AssetBytes& copy) { poseIn(copy, 1).name.at = ~0u; }, "without name");
    refused([&](AssetBytes& copy) { poseIn(copy, 1).name.bytes = ~0u; }, "without name");
    refused(
        [&](AssetBytes& copy) {
            for (format::Section& section : copy.table())
                if (std::string_view(section.kind.data(), 4) == "POSD") section.bytes -= 4, --section.count;
        },
        "directions of 2 poses");
    refused(
        [&](AssetBytes& copy) {
            for (format::Section& section : copy.table())
                if (std::string_view(section.kind.data(), 4) == "POSW") --section.bytes, --section.count;
        },
        "weights of poses");
    std::mt19937 random(3);
    std::size_t refusals = 0, played = 0;
    for (const char* kind : {"POSE", "POSD", "POSW"}) {
        AssetBytes copy(bytes_);
        const format::Section section = sectionOf(copy, kind);
        const std::size_t step = std::max<std::size_t>(1, section.bytes / 64);
        for (std::size_t at = section.offset; at < section.offset + section.bytes; at += step) {
            const std::byte was = copy.span()[at];
            copy.span()[at] ^= static_cast<std::byte>(random() % 255 + 1);
            copy.seal();
            game::Asset asset;
            ASSERT_TRUE(asset.open(copy.span().data(), copy.span().size()));
            Instance hair;
            if (!asset.check() || !hair.make(asset, HL_GUIDES | HL_LEVELS)) {
                ++refusals;
            } else {
                for (std::uint32_t k = 0; k < asset.describe().poses; ++k) ASSERT_TRUE(hair.setPose(k, 1));
                for (int f = 1; f <= 6; ++f) {
                    play(hair, f, f + 1);
                    ASSERT_TRUE(hair.setLevel(static_cast<std::uint32_t>(f) % HL_LEVEL_COUNT));
                    for (const Vec3f& point : guides(hair))
                        ASSERT_TRUE(point.allFinite()) << kind << " " << at;
                }
                ++played;
            }
            copy.span()[at] = was;
        }
    }
    EXPECT_GT(refusals, 10u);
    EXPECT_GT(played, 100u);
}

/// A file of version 1.5 as it was first written: what reads it now reads what stood there then, as a reader
/// that was made from the page alone has it.
TEST_F(RuntimePoses, FilesOfTheFirstVersionWithPosesAreStillRead) {
    const auto bytes = readFile(sourceDir() / "tests/exporters/files/version_1_5.hairrt").value();
    const auto opened = runtime::Asset::open(bytes);
    ASSERT_TRUE(opened.asset) << opened.error.words;
    ASSERT_FALSE(opened.asset->check());
    EXPECT_EQ(opened.asset->minor(), 5u);
    ASSERT_EQ(opened.asset->poses().size(), 2u);
    EXPECT_EQ(opened.asset->text(opened.asset->poses()[0].name), "Bent");
    EXPECT_EQ(opened.asset->poses()[0].amount, 0.25f);
    EXPECT_EQ(opened.asset->text(opened.asset->poses()[1].name), "Tips");
    const auto rest = opened.asset->strandsAtRest();
    ASSERT_EQ(rest.positions_ss.size(), 192u);
    const auto bent = opened.asset->poseArrays(0, rest), tips = opened.asset->poseArrays(1, rest);
    EXPECT_TRUE(bent.weights.empty());
    const auto apart = [](const runtime::Float3& a, float x, float y, float z) {
        return (Vec3f(a.x, a.y, a.z) - Vec3f(x, y, z)).norm();
    };
    EXPECT_LT(apart(bent.positions_ss[7], 0.01815024f, 0.06723468f, 0.09349443f), 1e-6f);
    EXPECT_LT(apart(bent.positions_ss[191], 0.02183840f, 0.06814023f, -0.09280881f), 1e-6f);
    ASSERT_EQ(tips.weights.size(), 192u);
    EXPECT_EQ(tips.weights[0], 0);
    EXPECT_EQ(tips.weights[2], 73 / 255.0f);
    EXPECT_EQ(tips.weights[7], 1);
}

TEST_F(RuntimePoses, OlderReadersSkipThem) {
    open(posed());
    // What a reader of 1.4 does with kinds that it does not know: none of them is required.
    AssetBytes copy(bytes_);
    std::set<std::string> kinds;
    for (runtime::asset::Section& section : copy.table()) {
        const std::string kind(section.kind.data(), 4);
        if (!kind.starts_with("POS")) continue;
        EXPECT_EQ(section.flags, 0u) << kind;
        kinds.insert(kind);
        section.kind[0] = 'X';
    }
    EXPECT_EQ(kinds, (std::set<std::string>{"POSE", "POSD", "POSW"}));
    copy.seal();
    game::Asset asset;
    ASSERT_TRUE(asset.open(copy.span().data(), copy.span().size()));
    EXPECT_TRUE(asset.check());
    EXPECT_EQ(asset.describe().poses, 0u);
}

}  // namespace
}  // namespace hairloom::test
