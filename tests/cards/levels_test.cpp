// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/cards/levels.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cards/card_samples.h"

namespace hairloom::cards {
namespace {

using testing::HasSubstr;

void noProgress(std::string_view, double) {}

TEST(LevelSpecs, AreReadWithTheirDefaults) {
    const auto specs = parseLevels("strands:0.5,cards:120,cards:60@64,shell");
    ASSERT_TRUE(specs) << specs.error().message();
    ASSERT_EQ(specs->size(), 4u);
    EXPECT_EQ((*specs)[0].kind, LevelKind::strands);
    EXPECT_DOUBLE_EQ((*specs)[0].amount, 0.5);
    EXPECT_EQ((*specs)[0].headPx, 512u);
    EXPECT_EQ((*specs)[1].headPx, 256u);
    EXPECT_EQ((*specs)[2].headPx, 64u);
    EXPECT_EQ((*specs)[3].kind, LevelKind::shell);
    EXPECT_EQ((*specs)[3].headPx, 32u);
    EXPECT_TRUE(parseLevels(standardLevels(200)));
    EXPECT_TRUE(parseLevels(standardLevels(1)));
}

TEST(LevelSpecs, SayWhatIsWrong) {
    for (const auto& [text, problem] : std::vector<std::pair<std::string, std::string>>{
             {"", "unknown kind"},
             {"cards:12@100", "pixels out of range"},
             {"cards:12@x", "not a number"},
             {"cards:1.5", "not a whole number"},
             {"cards:nan", "out of range"},
             {"strands:2", "out of range"},
             {"cards:50@64,cards:20@128", "nearer than the one before"},
             {"shell:3", "out of range"}}) {
        const auto specs = parseLevels(text);
        ASSERT_FALSE(specs) << text;
        EXPECT_THAT(specs.error().message(), HasSubstr(problem)) << text;
    }
}

TEST(Judge, SeesNoDifferenceBetweenHairAndItself) {
    const Hair hair = ballHair(300);
    const auto light = HairLight::make(hair, nullptr);
    const auto views = viewsAround(hair, 3);
    const StrandLight onStrands = strandLight(hair, *light);
    std::vector<Shot> shots;
    for (const View& view : views) {
        Plate plate(view, kSamplesPerHead);
        plate.drawStrands(hair, onStrands);
        shots.push_back(plate.developed(64));
    }
    const auto off = difference(shots, shots);
    ASSERT_TRUE(off);
    EXPECT_EQ(off->coverage, 1);
    EXPECT_EQ(off->light, 1);
    EXPECT_EQ(off->flip, 0);
    EXPECT_EQ(off->silhouettePx, 0);
}

TEST(Judge, HeadsHideWhatIsBehindThem) {
    Hair hair = ballHair(300);
    const auto light = HairLight::make(hair, nullptr);
    const View view = viewsAround(hair, 1)[0];
    const auto covered = [&](const Hair& shown) {
        Plate plate(view, kSamplesPerHead);
        plate.drawHead(shown);
        plate.drawStrands(shown, strandLight(shown, *light));
        double sum = 0;
        for (const float c : plate.developed(64).coverage) sum += static_cast<double>(c);
        return sum;
    };
    const double bare = covered(hair);
    hair.headPositions_ws = {{-1, -1, 0.09f}, {1, -1, 0.09f}, {0, 1.5f, 0.09f}};
    hair.headIndices = {0, 1, 2};
    EXPECT_LT(covered(hair), 0.8 * bare);
    EXPECT_GT(covered(hair), 0);
    // Without light, on a plate that was used before for another picture.
    Plate plate(viewsAround(hair, 3)[1], 64);
    plate.drawHead(hair);
    plate.start(view, kSamplesPerHead);
    plate.drawHead(hair);
    plate.coverByStrands(hair);
    double sum = 0;
    for (const float c : plate.developed(64).coverage) sum += static_cast<double>(c);
    EXPECT_EQ(sum, covered(hair));
}

TEST(Levels, OfABallComeNearTheStrands) {
    const Hair hair = ballHair(3000);
    const auto specs = parseLevels("strands:1@256,strands:0.3@128,cards:60@128,cards:30@64,shell:400@32");
    ASSERT_TRUE(specs);
    ChainOptions options;
    options.directions = 6;
    options.mostSide = 1024;
    options.walk = true;
    const auto chain = makeChain(hair, *specs, options, noProgress, nullptr);
    ASSERT_TRUE(chain) << chain.error().message();
    ASSERT_EQ(chain->levels.size(), 5u);
    EXPECT_EQ(chain->levels[0].difference.flip, 0);
    for (const Level& level : chain->levels) {
        EXPECT_NEAR(level.difference.coverage, 1, 0.05) << level.name;
        EXPECT_NEAR(level.difference.light, 1, 0.05) << level.name;
        EXPECT_LT(level.difference.flip, 0.15) << level.name;
        EXPECT_GT(level.triangles, 0u) << level.name;
    }
    // Who walks away sees each level from where it takes over to where the next one does.
    const std::vector<std::vector<std::uint32_t>> heights{
        {256, 192, 128}, {128}, {128, 96, 64}, {64, 48, 32}, {32, 24, 16}};
    for (std::size_t i = 0; i < heights.size(); ++i) {
        std::vector<std::uint32_t> seen;
        for (const LightAt& at : chain->levels[i].lights) {
            seen.push_back(at.headPx);
            EXPECT_NEAR(at.light, 1, 0.05) << chain->levels[i].name << " at " << at.headPx;
        }
        EXPECT_EQ(seen, heights[i]) << chain->levels[i].name;
    }
    for (const double step : lightSteps(chain->levels)) EXPECT_LT(step, 0.05);
    EXPECT_EQ(chain->springs.size(), chain->rig.chains());
    EXPECT_EQ(chain->levels[1].hairs, 900u);
    EXPECT_LE(chain->levels[2].cards(), 60u);
    EXPECT_LT(chain->levels[3].triangles, chain->levels[2].triangles);
    EXPECT_LE(chain->levels[4].triangles, 440u);
}

TEST(Levels, AreMeasuredFromTwiceAsManyDirections) {
    Hair hair = ballHair(3000);
    addBallHead(hair);
    const auto specs = parseLevels("strands:1@128,strands:0.5@128,cards:3@128");
    ChainOptions options;
    options.directions = 3;
    options.mostSide = 256;
    const auto plain = makeChain(hair, *specs, options, noProgress, nullptr);
    ASSERT_TRUE(plain) << plain.error().message();
    for (const Level& level : plain->levels) EXPECT_FALSE(level.measures);
    options.measure = true;
    const auto chain = makeChain(hair, *specs, options, noProgress, nullptr);
    ASSERT_TRUE(chain) << chain.error().message();
    for (const Level& level : chain->levels) {
        ASSERT_TRUE(level.measures) << level.name;
        EXPECT_TRUE(level.measures->largestPatchCm2 && level.measures->hairlineMm && level.measures->rim)
            << level.name;
    }
    EXPECT_EQ(chain->levels[0].measures->hairlineMm, 0);
    EXPECT_EQ(chain->levels[0].measures->scaliness, 1);
    EXPECT_THAT(chain->levels[0].fails(), testing::IsEmpty());
    EXPECT_LT(*chain->levels[1].measures->hairlineMm, *chain->levels[2].measures->hairlineMm);
    EXPECT_THAT(chain->levels[2].fails(), testing::Contains("largest_patch_cm2")) << "three cards";
    EXPECT_EQ(chain->levels[2].difference.flip, plain->levels[2].difference.flip)
        << "measuring changes nothing";
}

TEST(Levels, StepsOfLightAreThoseOnTheWay) {
    std::vector<Level> levels(3);
    levels[0].lights = {{512, 1.0}, {256, 1.0}};
    levels[1].lights = {{256, 0.9}, {128, 0.99}};
    levels[2].lights = {{128, 0.99}};
    const auto steps = lightSteps(levels);
    ASSERT_EQ(steps.size(), 3u);
    EXPECT_EQ(steps[0], 0);
    EXPECT_NEAR(steps[1], 0.1, 1e-9);
    EXPECT_EQ(steps[2], 0);
}

TEST(Levels, OfferTheNearestTargetWhereOneCannotBeMet) {
    const Hair hair = ballHair(500);
    const auto specs = parseLevels("cards:2@256");
    ChainOptions options;
    options.directions = 2;
    options.targetPx = 0.05f;
    const auto chain = makeChain(hair, *specs, options, noProgress, nullptr);
    ASSERT_FALSE(chain);
    EXPECT_THAT(chain.error().message(), HasSubstr("more than the 0.05 asked for; use a limit of "));
}

TEST(Levels, StopWhenTheyAreCancelled) {
    const std::atomic<bool> cancel = true;
    const auto chain = makeChain(ballHair(50), *parseLevels("cards:4"), {}, noProgress, &cancel);
    ASSERT_FALSE(chain);
    EXPECT_THAT(chain.error().message(), HasSubstr("stopped"));
}

}  // namespace
}  // namespace hairloom::cards
