// SPDX-License-Identifier: GPL-3.0-or-later
// Hair for the renderer while a brush moves it.
#include "core/live/groom_scene.h"

#include <gtest/gtest.h>

#include "core/documents/sample.h"
#include "tests/support/source_dir.h"

namespace hairloom {
namespace {

class GroomSceneStroke : public testing::Test {
  protected:
    static void SetUpTestSuite() { groom_ = makeSample(sourceDir() / "samples", "short").value(); }
    static void TearDownTestSuite() { groom_ = {}; }

    /// Every tenth strand, bent to one side from its second point on.
    static std::vector<std::uint32_t> touched() {
        std::vector<std::uint32_t> strands;
        for (std::uint32_t s = 0; s < groom_.strandCount(); s += 10) strands.push_back(s);
        return strands;
    }
    static std::vector<Vec3f> bent(const std::vector<std::uint32_t>& strands,
                                   const Vec3f& rootMoves = Vec3f::Zero()) {
        std::vector<Vec3f> points;
        for (const std::uint32_t s : strands) {
            const auto strand = groom_.strand(s);
            for (std::size_t i = 0; i < strand.size(); ++i)
                points.emplace_back(strand[i] + rootMoves + Vec3f(0.002f * static_cast<float>(i), 0, 0));
        }
        return points;
    }
    static std::vector<Vec3f> drawn(const GroomScene& scene) {
        const render::RenderScene shown = scene.scene();
        const auto positions = shown.strands.at(0).positions_ws;
        return {positions.begin(), positions.end()};
    }
    static Groom groom_;
};
Groom GroomSceneStroke::groom_;

TEST_F(GroomSceneStroke, FollowHairsGoWithTheGuidesThatItTouches) {
    ASSERT_GT(groom_.interpolation.followPerGuide, 0u);
    auto stroke = GroomScene::make(groom_, {}, {}).value();
    auto whole = GroomScene::make(groom_, {}, {}).value();
    const std::vector<Vec3f> before = drawn(stroke);
    const std::vector<std::uint32_t> strands = touched();
    const std::vector<Vec3f> points = bent(strands);
    EXPECT_FALSE(stroke.isBindingOld());
    ASSERT_TRUE(stroke.moveStrands(strands, points));
    EXPECT_TRUE(stroke.isBindingOld());

    std::vector<Vec3f> all(groom_.positions().begin(), groom_.positions().end());
    std::size_t from = 0, moved = 0;
    for (const std::uint32_t s : strands) {
        for (std::uint32_t p = groom_.offsets.view()[s]; p < groom_.offsets.view()[s + 1]; ++p)
            all[p] = points[from++];
    }
    whole.pose(all, {}, {});
    const std::vector<Vec3f> after = drawn(stroke);
    EXPECT_EQ(after, drawn(whole)) << "as if all strands had been handed over";
    for (std::size_t p = 0; p < after.size(); ++p) moved += after[p] != before[p] ? 1 : 0;
    EXPECT_GT(moved, after.size() / 20);
    EXPECT_LT(moved, after.size() / 2 + after.size() / 4) << "hair that nobody touched stays";
}

TEST_F(GroomSceneStroke, AgreesWithASceneMadeAgainWhereNoPartingOpens) {
    auto stroke = GroomScene::make(groom_, {}, {}).value();
    std::vector<std::uint32_t> strands(groom_.strandCount());
    for (std::uint32_t s = 0; s < groom_.strandCount(); ++s) strands[s] = s;
    const std::vector<Vec3f> points = bent(strands);
    ASSERT_TRUE(stroke.moveStrands(strands, points));
    Groom now = groom_;
    now.pointAttributes.set(attribute::kPosition, points);
    const auto again = GroomScene::make(now, {}, {}).value();
    const std::vector<Vec3f> a = drawn(stroke), b = drawn(again);
    ASSERT_EQ(a.size(), b.size());
    double sum = 0;
    for (std::size_t p = 0; p < a.size(); ++p) sum += static_cast<double>((a[p] - b[p]).norm());
    EXPECT_LT(sum / static_cast<double>(a.size()), 0.001) << "metres, in the mean";
}

TEST_F(GroomSceneStroke, RootsThatMoveTakeASceneMadeAgain) {
    auto scene = GroomScene::make(groom_, {}, {}).value();
    const std::vector<Vec3f> before = drawn(scene);
    EXPECT_FALSE(scene.moveStrands(touched(), bent(touched(), Vec3f(0, 0.001f, 0))));
    EXPECT_FALSE(scene.isBindingOld());
    EXPECT_EQ(drawn(scene), before);
}

TEST_F(GroomSceneStroke, StrandsThatAreDrawnThemselvesMayMoveWithTheirRoots) {
    Groom plain = groom_;
    plain.interpolation.followPerGuide = 0;
    auto scene = GroomScene::make(plain, {}, {}).value();
    const std::vector<Vec3f> points = bent({3}, Vec3f(0, 0.001f, 0));
    const std::vector<std::uint32_t> one{3};
    ASSERT_TRUE(scene.moveStrands(one, points));
    EXPECT_EQ(drawn(scene)[groom_.offsets.view()[3]], points[0]);
    EXPECT_FALSE(scene.isBindingOld());
}

}  // namespace
}  // namespace hairloom
