// SPDX-License-Identifier: GPL-3.0-or-later
// The skin collider in runtime assets: games play it with the positions of the editor's simulation.

#include <gmock/gmock.h>

#include <algorithm>
#include <array>

#include "core/simulation/bake_body.h"
#include "core/simulation/clip_motion.h"
#include "core/simulation/simulation.h"
#include "hairloom/body_bytes.h"
#include "hairloom/hairloom.hpp"
#include "importers/strands.h"
#include "tests/exporters/asset_bytes.h"
#include "tests/exporters/asset_samples.h"
#include "tests/exporters/character_sample.h"
#include "tests/geometry/test_meshes.h"

namespace hairloom::test {
namespace {

using game::Asset;
using game::Error;
using game::Frame;
using game::Instance;
using runtime::BodyField;
using testing::HasSubstr;
constexpr float kFrame = 1.0f / 60.0f;
constexpr float kBall = 0.1f;
constexpr std::uint32_t kPoints = 12;

/// Soft hair on the upper half of a ball, which falls into it where nothing protects it.
Groom ballOfHair(bool protectedBySkin) {
    auto mesh = std::make_shared<const ScalpMesh>(meshOf(icosphereSoup(4, kBall)));
    FaceSet top;
    std::vector<SurfacePoint> roots;
    for (std::uint32_t t = 0; t < mesh->triangleCount(); ++t) {
        if (mesh->pointAt(t, Vec3f(1, 1, 1) / 3).y() < 0.02f) continue;
        top.push_back(t);
        if (t % 11 == 0) roots.push_back({t, Vec3f(0.3f, 0.3f, 0.4f)});
    }
    Groom groom = growStraight(mesh, top, roots, 0.12f, kPoints).value();
    groom.simulation.angularStiffness = 0.05f;
    groom.simulation.restGravity = 0;
    if (protectedBySkin) groom.body = bakeBodyOf(groom, nullptr).value().field;
    return groom;
}

const Groom& hairyBall() {
    static const Groom kGroom = ballOfHair(true);
    return kGroom;
}

Character characterWithSkin() {
    Character made = character();
    made.groom.simulation.angularStiffness = 0.02f;
    made.groom.body = bakeBodyOf(made.groom, made.actor.get()).value().field;
    return made;
}

HeadPose noddingAt(int frame) {
    const float time = static_cast<float>(frame) * kFrame;
    HeadPose pose;
    pose.head_ws = Eigen::Translation3f(0.1f * std::sin(3 * time), 0, 0) *
                   Eigen::AngleAxisf(0.6f * std::sin(6 * time), Vec3f::UnitX());
    return pose;
}

class RuntimeBody : public AssetTest {
  protected:
    Asset opened(const Groom& groom) {
        bytes_ = written(groom, &report_);
        Asset asset;
        Error error;
        EXPECT_TRUE(asset.open(bytes_.data(), bytes_.size(), &error)) << error.what();
        EXPECT_FALSE(runtime::Asset::open(bytes_).asset->check());
        return asset;
    }
    static void step(Instance& hair, int frame) {
        std::array<float, 12> head = rows(noddingAt(frame).head_ws.matrix());
        Frame given(kFrame);
        given.head = head.data();
        given.time = static_cast<double>(frame) * static_cast<double>(kFrame);
        Error error;
        ASSERT_TRUE(frame == 0 ? hair.reset(given, &error) : hair.step(given, &error)) << error.what();
    }
    /// Metres that points other than the first two of strands lie in the ball.
    static float deepest(const std::vector<float>& points, int frame) {
        const Eigen::Isometry3f toBall = noddingAt(frame).head_ws.inverse();
        float depth = 0;
        for (std::size_t p = 0; 3 * p < points.size(); ++p) {
            const Vec3f at = toBall * Vec3f(points[3 * p], points[3 * p + 1], points[3 * p + 2]);
            if (p % kPoints > 1) depth = std::max(depth, kBall - at.norm());
        }
        return depth;
    }

    std::vector<std::byte> bytes_;
    ExportReport report_;
};

TEST_F(RuntimeBody, GivesTheBitsOfTheEditorsSimulation) {
    Instance hair, bare;
    ASSERT_TRUE(hair.make(opened(hairyBall()), HL_GUIDES));
    Groom read = importStrands(folder / "a.hairrt")->groom;
    read.body = hairyBall().body;
    auto simulation = Simulation::make(read, noddingAt(0)).value();
    ASSERT_TRUE(bare.make(opened(ballOfHair(false)), HL_GUIDES));
    step(hair, 0);
    step(bare, 0);
    std::vector<float> points, unprotected;
    float kept = 0, lost = 0;
    for (int f = 1; f <= 90; ++f) {
        simulation.step(kFrame, noddingAt(f));
        step(hair, f);
        step(bare, f);
        ASSERT_TRUE(hair.readGuides(points));
        ASSERT_TRUE(bare.readGuides(unprotected));
        for (std::size_t p = 0; p < read.pointCount(); ++p) {
            const Vec3f& at = simulation.positions_ws()[p];
            ASSERT_TRUE(points[3 * p] == at.x() && points[3 * p + 1] == at.y() && points[3 * p + 2] == at.z())
                << "frame " << f << ", point " << p;
        }
        kept = std::max(kept, deepest(points, f));
        lost = std::max(lost, deepest(unprotected, f));
    }
    EXPECT_LT(kept, 0.01f) << "as deep as in the editor";
    EXPECT_GT(lost, 0.02f);
}

TEST_F(RuntimeBody, SpheresThatStandForTheSkinLeaveHairToIt) {
    Groom with = hairyBall();
    with.spheres = {{"skull", Vec3f(0, 0.02f, 0), 0.09f, {}, -1}};
    Instance bare, skull, own;
    ASSERT_TRUE(bare.make(opened(hairyBall()), HL_GUIDES | HL_LEVELS));
    ASSERT_TRUE(skull.make(opened(with), HL_GUIDES | HL_LEVELS));
    ASSERT_TRUE(own.make(opened(with), HL_GUIDES));
    std::vector<float> points, others, pushed;
    const auto sameAt = [&](int first, int last) {
        for (int f = first; f <= last; ++f) {
            step(bare, f);
            step(skull, f);
        }
        EXPECT_TRUE(bare.readGuides(points) && skull.readGuides(others));
        return points == others;
    };
    EXPECT_TRUE(sameAt(0, 30));
    // A game's spheres push, whatever they stand for.
    for (int f = 0; f <= 30; ++f) {
        std::array<float, 12> head = rows(noddingAt(f).head_ws.matrix());
        const Vec3f centre = noddingAt(f).head_ws * Vec3f(0, 0.02f, 0);
        const std::array<float, 4> sphere{centre.x(), centre.y(), centre.z(), 0.09f};
        Frame given(kFrame);
        given.head = head.data();
        given.time = static_cast<double>(f) * static_cast<double>(kFrame);
        given.spheres = sphere.data();
        given.sphere_count = 1;
        ASSERT_TRUE(f == 0 ? own.reset(given) : own.step(given));
    }
    ASSERT_TRUE(own.readGuides(pushed));
    EXPECT_NE(pushed, others);
    // The engine of a coarser level knows, too.
    for (Instance* hair : {&bare, &skull})
        ASSERT_EQ(hl_instance_set_level(hair->get(), 1, 1, nullptr), HL_OK);
    EXPECT_TRUE(sameAt(31, 60));
}

TEST_F(RuntimeBody, SavedStatesRunOnWithTheSameBits) {
    const Asset asset = opened(hairyBall());
    Instance hair, other;
    ASSERT_TRUE(hair.make(asset, HL_GUIDES));
    ASSERT_TRUE(other.make(asset, HL_GUIDES));
    for (int f = 0; f <= 30; ++f) step(hair, f);
    std::size_t size = 0;
    ASSERT_EQ(hl_instance_save(hair.get(), nullptr, 0, &size, nullptr), HL_OK);
    std::vector<std::byte> saved(size);
    ASSERT_EQ(hl_instance_save(hair.get(), saved.data(), size, &size, nullptr), HL_OK);
    ASSERT_EQ(hl_instance_load(other.get(), saved.data(), size, nullptr), HL_OK);
    for (int f = 31; f <= 50; ++f) {
        step(hair, f);
        step(other, f);
        ASSERT_EQ(hair.hash(), other.hash()) << f;
    }
}

TEST_F(RuntimeBody, ImportSaysThatTheSkinStaysBehind) {
    opened(hairyBall());
    const auto read = importStrands(folder / "a.hairrt");
    ASSERT_TRUE(read);
    EXPECT_FALSE(read->groom.body) << "it goes with a head";
    EXPECT_THAT(read->warnings, testing::Contains(testing::Field(&Finding::where, "body")));
    opened(ballOfHair(false));
    EXPECT_THAT(importStrands(folder / "a.hairrt")->warnings,
                testing::Not(testing::Contains(testing::Field(&Finding::where, "body"))));
}

TEST_F(RuntimeBody, MemoryIsStatedAtAllLevels) {
    const Asset asset = opened(hairyBall());
    Instance hair;
    ASSERT_TRUE(hair.make(asset, HL_GUIDES | HL_LEVELS));
    for (int f = 0; f <= 60; ++f) {
        if (f == 10) {
            ASSERT_TRUE(hair.setLevel(1, 1));
        }
        step(hair, f);
    }
    const hl_asset_info info = asset.describe();
    EXPECT_LE(hair.describe().bytes, info.guides_memory + info.levels_memory);
}

TEST_F(RuntimeBody, FollowsTheBonesOfAClipAsTheEditorDoes) {
    const Character made = characterWithSkin();
    ASSERT_GT(made.groom.body->bones.size(), 1u);
    const Asset asset = opened(made.groom);
    EXPECT_THAT(report_.findings,
                testing::Contains(testing::Field(&Finding::what, HasSubstr("skin collider takes"))));
    const auto section = runtime::Asset::open(bytes_).asset->body();
    EXPECT_GT(section.size(), 1000u);
    EXPECT_LT(section.size(), made.groom.body->bytes() / 2);
    std::vector<std::uint32_t> indices;
    for (std::uint32_t b = 0; b < asset.describe().bones; ++b) {
        hl_bone bone{};
        ASSERT_EQ(hl_asset_bone(asset.get(), b, &bone, nullptr), HL_OK);
        indices.push_back(bone.index);
    }
    const auto motion = makeClipMotion(made.actor, made.actor->clips().front().name, made.groom).value();
    auto simulation = Simulation::make(made.groom, motion->poseAt(0)).value();
    std::vector<float> bones(12 * indices.size()), points;
    Frame frame(kFrame);
    frame.bones = bones.data();
    frame.bone_count = indices.size();
    const auto pose = [&](const HeadPose& head) {
        for (std::size_t b = 0; b < indices.size(); ++b) {
            const auto matrix = rows(head.bones_ws[indices[b]].matrix());
            std::ranges::copy(matrix, bones.begin() + static_cast<std::ptrdiff_t>(12 * b));
        }
    };
    Instance hair;
    ASSERT_TRUE(hair.make(asset, HL_GUIDES));
    pose(motion->poseAt(0));
    ASSERT_TRUE(hair.reset(frame));
    float farthest = 0;
    for (int f = 1; f <= 30; ++f) {
        const HeadPose head = motion->poseAt(static_cast<float>(f) * kFrame);
        pose(head);
        simulation.step(kFrame, head);
        frame.time = static_cast<double>(f) * static_cast<double>(kFrame);
        ASSERT_TRUE(hair.step(frame));
        ASSERT_TRUE(hair.readGuides(points));
        for (std::size_t p = 0; p < made.groom.pointCount(); ++p)
            farthest = std::max(farthest, (Vec3f(points[3 * p], points[3 * p + 1], points[3 * p + 2]) -
                                           simulation.positions_ws()[p])
                                              .norm());
    }
    EXPECT_LT(farthest, 0.001f) << "rest positions and weights are rounded";
}

TEST_F(RuntimeBody, PackedBodiesAreTheSameToTheBitAndDamageIsRefusedOrSound) {
    const BodyField& field = *hairyBall().body;
    const std::vector<std::uint8_t> plain = field.toBytes(), packed = runtime::packBody(field);
    EXPECT_LT(packed.size(), plain.size() / 2);
    const auto read = runtime::bodyFieldFromBytes(packed);
    ASSERT_TRUE(read.field) << read.error;
    EXPECT_EQ(read.field->toBytes(), plain);
    for (std::size_t size = 0; size < packed.size(); size += size < 200 ? 1 : 997)
        EXPECT_FALSE(runtime::bodyFieldFromBytes(std::span(packed).first(size)).field) << size;
    std::vector<std::uint8_t> longer = packed;
    longer.push_back(0);
    EXPECT_FALSE(runtime::bodyFieldFromBytes(longer).field);
    std::size_t sound = 0, refused = 0;
    for (std::size_t at = 0; at < packed.size(); at += at < 200 ? 1 : 499) {
        std::vector<std::uint8_t> changed = packed;
        changed[at] ^= static_cast<std::uint8_t>(1u << (at % 8));
        const auto other = runtime::bodyFieldFromBytes(changed);
        other.field ? ++sound : ++refused;
        if (other.field) {
            EXPECT_EQ(other.field->problem(), "");
        }
    }
    EXPECT_GT(refused, 20u);
    EXPECT_GT(sound, 20u);
    // Sizes that so few bytes cannot have are refused before memory is asked for.
    for (const std::uint32_t cells : {0u, 100'000u, 0xffffffffu}) {
        std::vector<std::uint8_t> huge(packed.begin(), packed.begin() + 200);
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (std::size_t byte = 0; byte < 4; ++byte)
                huge[28 + 4 * axis + byte] = static_cast<std::uint8_t>(cells >> (8 * byte));
        EXPECT_FALSE(runtime::bodyFieldFromBytes(huge).field) << cells;
    }
}

TEST_F(RuntimeBody, ABoneThatTheFileLacksIsRefused) {
    AssetBytes copy(written(characterWithSkin().groom));
    const auto opened = runtime::Asset::open(copy.span());
    ASSERT_TRUE(opened.asset);
    ASSERT_FALSE(opened.asset->check());
    const std::span<const std::byte> body = opened.asset->body();
    constexpr std::array<std::byte, 4> kName{std::byte{'h'}, std::byte{'e'}, std::byte{'a'}, std::byte{'d'}};
    const auto found = std::search(body.begin(), body.end(), kName.begin(), kName.end());
    ASSERT_NE(found, body.end());
    copy.span()[static_cast<std::size_t>(&*found - copy.span().data())] = std::byte{'H'};
    copy.seal();
    const auto problem = runtime::Asset::open(copy.span()).asset->check();
    ASSERT_TRUE(problem);
    EXPECT_THAT(problem->words, HasSubstr("bone that the file does not have"));
}

}  // namespace
}  // namespace hairloom::test
