// SPDX-License-Identifier: GPL-3.0-or-later
// Roots of cards move with the skin of real characters, in all of their clips.
#include "exporters/card_character.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "exporters/avatar_bones.h"
#include "tests/exporters/character_sample.h"

namespace hairloom {
namespace {

struct Grown {
    test::Character character;
    std::vector<Vec3f> roots_ws;
};

/// Hair at `share` of the height and above.
Grown grownOn(const std::filesystem::path& file, float share) {
    Grown grown;
    auto scene = importScene(file).value();
    auto mesh = std::make_shared<const ScalpMesh>(scene.mesh);
    const Box3f bounds = mesh->bounds();
    FaceSet top;
    std::vector<SurfacePoint> roots;
    for (std::uint32_t t = 0; t < mesh->triangleCount(); ++t) {
        const Vec3f middle = mesh->pointAt(t, Vec3f(1, 1, 1) / 3);
        if (middle.y() < bounds.min().y() + share * bounds.sizes().y()) continue;
        top.push_back(t);
        roots.push_back({t, Vec3f(0.25f, 0.25f, 0.5f)});
    }
    grown.character.groom = growStraight(mesh, top, roots, 0.1f, 4).value();
    grown.character.groom.characterFile = file.string();
    grown.character.actor = std::make_shared<const Actor>(
        Actor::make(mesh, std::move(scene.skeleton), std::move(scene.clips), std::move(scene.skin)).value());
    for (std::size_t s = 0; s < grown.character.groom.strandCount(); ++s)
        grown.roots_ws.push_back(grown.character.groom.strand(s)[0]);
    return grown;
}

/// The farthest that a root leaves its place on the posed skin, in a clip, and how far the skin goes.
std::pair<float, float> worstOf(const Grown& grown, const cards::Character& bones, std::uint32_t clip) {
    const Actor& actor = *grown.character.actor;
    const auto bindings = grown.character.groom.rootBindings();
    float worst = 0, way = 0;
    for (const float time : {0.0f, 0.21f, 0.4f, 0.77f}) {
        const ActorPose pose = actor.poseAt(clip, time, Wrap::Loop);
        for (std::size_t r = 0; r < grown.roots_ws.size(); ++r) {
            Vec3f there = Vec3f::Zero(), expected = Vec3f::Zero();
            for (std::size_t k = 0; k < 4; ++k) {
                const float weight = bones.roots[r].weights[static_cast<int>(k)];
                if (weight == 0) continue;
                const auto bone = actor.skeleton().find(bones.bones[bones.roots[r].bones[k]].name);
                there += weight * (pose.boneMatrices_ws[*bone] * grown.roots_ws[r]);
            }
            for (int corner = 0; corner < 3; ++corner)
                expected += bindings[r].barycentric[corner] *
                            pose.positions_ws[actor.mesh().triangles()[bindings[r].triangle]
                                                                      [static_cast<std::size_t>(corner)]];
            worst = std::max(worst, (there - expected).norm());
            way = std::max(way, (expected - grown.roots_ws[r]).norm());
        }
    }
    return {worst, way};
}

struct Real {
    const char* file;
    float share;    ///< of the height from which hair grows: neck and shoulders, too
    float mostOff;  ///< as a share of the height
};
void PrintTo(const Real& real, std::ostream* out) {
    *out << real.file;
}
class CardCharacter : public testing::TestWithParam<Real> {};

TEST_P(CardCharacter, RootsStayOnTheSkinInEveryClip) {
    const auto file = outsideData() / "animated" / GetParam().file;
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "no data beside this checkout: " << file;
    const Grown grown = grownOn(file, GetParam().share);
    std::vector<Finding> findings;
    const cards::Character bones = cardCharacter({grown.character.groom, grown.roots_ws}, findings);
    EXPECT_TRUE(findings.empty());
    ASSERT_EQ(bones.roots.size(), grown.roots_ws.size());
    std::size_t blended = 0;
    for (const cards::Character::Root& root : bones.roots) {
        EXPECT_NEAR(root.weights.sum(), 1, 1e-5f);
        blended += root.weights[1] > 0.05f ? 1 : 0;
        for (std::size_t k = 0; k < 4; ++k) ASSERT_LT(root.bones[k], bones.bones.size());
    }
    EXPECT_GT(blended, 0u) << "hair grows where several bones move the skin";
    cards::Character onHead = bones;
    for (cards::Character::Root& root : onHead.roots)
        root = {{static_cast<std::uint16_t>(bones.head)}, Vec4f(1, 0, 0, 0)};
    const Actor& actor = *grown.character.actor;
    const float height = actor.mesh().bounds().sizes().y();
    ASSERT_FALSE(actor.clips().empty());
    float worst = 0, way = 0, worstOnHead = 0;
    for (std::uint32_t clip = 0; clip < actor.clips().size(); ++clip) {
        const auto [off, gone] = worstOf(grown, bones, clip);
        worst = std::max(worst, off), way = std::max(way, gone);
        worstOnHead = std::max(worstOnHead, worstOf(grown, onHead, clip).first);
    }
    EXPECT_GT(way, 0.01f * height) << "the skin moves";
    // Corners of a triangle that bones turn apart move otherwise than a vertex between them.
    EXPECT_LT(worst, GetParam().mostOff * height);
    EXPECT_LT(worst, 0.5f * worstOnHead) << "better than all on the head's bone";
}

INSTANTIATE_TEST_SUITE_P(Real, CardCharacter,
                         testing::Values(Real{"CesiumMan.glb", 0.75f, 0.005f},
                                         Real{"raylib_greenman.glb", 0.6f, 0.025f},
                                         Real{"ufbx_blender_279_sausage_7400_binary.fbx", 0.3f, 0.006f}));

TEST(CardCharacterRoots, AreRenumberedBehindAnAddedBody) {
    const test::Character sample = test::character();
    std::vector<Vec3f> roots;
    for (std::size_t s = 0; s < sample.groom.strandCount(); ++s) roots.push_back(sample.groom.strand(s)[0]);
    std::vector<Finding> findings;
    const cards::Character own = cardCharacter({sample.groom, roots}, findings);
    const cards::Character avatar = avatarCharacter({sample.groom, roots}, "it", findings);
    ASSERT_GE(avatar.bones.size(), own.bones.size());
    ASSERT_EQ(avatar.roots.size(), own.roots.size());
    for (std::size_t r = 0; r < own.roots.size(); ++r) {
        EXPECT_EQ(own.roots[r].weights, avatar.roots[r].weights);
        for (std::size_t k = 0; k < 4; ++k) {
            if (own.roots[r].weights[static_cast<int>(k)] == 0) continue;
            EXPECT_EQ(own.bones[own.roots[r].bones[k]].name, avatar.bones[avatar.roots[r].bones[k]].name);
        }
    }
}

}  // namespace
}  // namespace hairloom
