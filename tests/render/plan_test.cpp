// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/render/plan.h"

#include <gtest/gtest.h>

#include <set>

#include "core/render/opacity_layers.h"

namespace hairloom::render {
namespace {

SceneFacts wholeScene() {
    SceneFacts facts;
    facts.meshes = facts.hair = true;
    facts.lights = 3;
    facts.shadowLights = 2;
    return facts;
}

RenderOptions options(Shadows shadows = Shadows::deepOpacity) {
    RenderOptions result;
    result.width = 100;
    result.height = 50;
    result.shadowResolution = 64;
    result.shadows = shadows;
    return result;
}

bool anyShadow(const RenderPlan& plan) {
    return plan.runs(Pass::headDepth) || plan.runs(Pass::firstHair) || plan.runs(Pass::opacity) ||
           plan.has(TargetId::headDepth) || plan.has(BufferId::firstHair) || plan.has(BufferId::opacity) ||
           plan.has(BufferId::layerCounts);
}

TEST(RenderPlan, ShadowsNeedALightThatCastsThemAndSomethingThatThrowsThem) {
    EXPECT_TRUE(anyShadow(planRender(wholeScene(), options(), 4)));
    EXPECT_FALSE(anyShadow(planRender(wholeScene(), options(Shadows::none), 4)));
    SceneFacts facts = wholeScene();
    facts.shadowLights = 0;
    EXPECT_FALSE(anyShadow(planRender(facts, options(), 4)));
    facts = wholeScene();
    facts.hair = false;
    const RenderPlan bald = planRender(facts, options(), 4);
    EXPECT_TRUE(bald.runs(Pass::headDepth));
    EXPECT_FALSE(bald.runs(Pass::firstHair));
    EXPECT_FALSE(bald.runs(Pass::opacity));
    EXPECT_FALSE(bald.runs(Pass::curves));
    EXPECT_FALSE(bald.runs(Pass::shade));
}

TEST(RenderPlan, TheSkyIsMappedWhereItShinesOnSomething) {
    const auto anySky = [](const RenderPlan& plan) {
        return plan.runs(Pass::skyHead) || plan.runs(Pass::skyFirst) || plan.runs(Pass::skyLayers) ||
               plan.runs(Pass::skySeen) || plan.has(TargetId::skyHead) || plan.has(BufferId::skyFirst) ||
               plan.has(BufferId::skyCounts) || plan.has(BufferId::skyLayers);
    };
    SceneFacts facts = wholeScene();
    EXPECT_FALSE(anySky(planRender(facts, options(), 1)));
    facts.environment = true;
    facts.shadowLights = 0;  // no matter
    const RenderPlan plan = planRender(facts, options(Shadows::absorption), 1);
    EXPECT_TRUE(plan.runs(Pass::skyHead) && plan.runs(Pass::skyFirst) && plan.runs(Pass::skyLayers) &&
                plan.runs(Pass::skySeen));
    EXPECT_EQ(plan.buffer(BufferId::skyLayers).bytes(), 12u * kSkyResolution * kSkyResolution * 8u);
    EXPECT_FALSE(anySky(planRender(facts, options(Shadows::none), 1)));
    facts.hair = false;
    const RenderPlan bald = planRender(facts, options(), 1);
    EXPECT_TRUE(bald.runs(Pass::skyHead));
    EXPECT_FALSE(bald.runs(Pass::skyLayers) || bald.runs(Pass::skySeen) || bald.has(BufferId::skyLayers));
    facts.meshes = false;
    EXPECT_FALSE(anySky(planRender(facts, options(), 1)));
}

TEST(RenderPlan, EachKindOfShadowHasItsPasses) {
    const RenderPlan absorption = planRender(wholeScene(), options(Shadows::absorption), 1);
    EXPECT_TRUE(absorption.runs(Pass::firstHair));
    EXPECT_FALSE(absorption.runs(Pass::opacity));
    const RenderPlan maps = planRender(wholeScene(), options(Shadows::opacityMaps), 1);
    EXPECT_FALSE(maps.runs(Pass::firstHair));
    EXPECT_TRUE(maps.runs(Pass::opacity));
    const RenderPlan deep = planRender(wholeScene(), options(), 1);
    EXPECT_EQ(deep.buffer(BufferId::opacity).bytes(), maps.buffer(BufferId::opacity).bytes());
    EXPECT_EQ(deep.buffer(BufferId::opacity).bytes(), 2u * 64u * 64u * 8u);
    SceneFacts facts = wholeScene();
    facts.fragments = 1000;
    const RenderPlan adaptive = planRender(facts, options(Shadows::adaptive), 1);
    EXPECT_FALSE(adaptive.runs(Pass::firstHair));
    EXPECT_TRUE(adaptive.runs(Pass::opacity));
    EXPECT_EQ(adaptive.buffer(BufferId::opacity).bytes(), 2u * 64u * 64u * 8u * 4u);
    EXPECT_EQ(adaptive.buffer(BufferId::layerCounts).bytes(), 2u * 64u * 64u * 4u);
    EXPECT_EQ(adaptive.buffer(BufferId::lightFragments).bytes(), 1000u * 12u);
    EXPECT_EQ(adaptive.buffer(BufferId::fragmentCounts).bytes(), 2u * 2u * 4u);
    EXPECT_FALSE(deep.has(BufferId::lightFragments) || maps.has(BufferId::fragmentCounts));
    // What counts them is there for one light after the other.
    EXPECT_EQ(deep.buffer(BufferId::layerCounts).bytes(), 64u * 64u * 3u * 4u);
}

TEST(RenderPlan, MoreLayersTakeMoreTexturesAndFewerWhereThereIsNoRoom) {
    // Of four channels each, one of which holds the first hair's depth.
    const std::pair<std::uint32_t, std::uint32_t> textures[] = {{3, 1}, {4, 2}, {7, 2}, {8, 3}, {11, 3}};
    for (const auto& [layers, count] : textures) {
        RenderOptions deep = options();
        deep.shadowLayers = layers;
        const RenderPlan plan = planRender(wholeScene(), deep, 1);
        EXPECT_EQ(plan.buffer(BufferId::opacity).bytes(), 2u * 64u * 64u * 8u * count) << layers;
        EXPECT_EQ(plan.buffer(BufferId::layerCounts).bytes(), 64u * 64u * 4u * layers);
        EXPECT_NE(plan.passes[static_cast<std::size_t>(Pass::opacity)].why.find(std::to_string(layers)),
                  std::string::npos);
    }
    for (const std::uint32_t slices : {1u, 4u, 5u, 16u}) {
        RenderOptions maps = options(Shadows::opacityMaps);
        maps.shadowSlices = slices;
        EXPECT_EQ(planRender(wholeScene(), maps, 1).buffer(BufferId::opacity).bytes(),
                  2u * 64u * 64u * 8u * ((slices + 3) / 4));
    }
    gpu::DeviceInfo small;
    small.maxBufferBytes = 64u * 64u * 4u * 7u;
    small.maxTextureSize = 4096;
    RenderOptions asked = options();
    asked.shadowLayers = 11;
    const RenderOptions chosen = chooseWays(asked, 1, true, small);
    EXPECT_EQ(chosen.shadowLayers, 7u);
    SceneFacts facts = wholeScene();
    facts.askedLayers = 11;
    EXPECT_NE(planRender(facts, chosen, 1)
                  .passes[static_cast<std::size_t>(Pass::opacity)]
                  .why.find("11 do not fit"),
              std::string::npos);
    asked.shadowLayers = 3;
    EXPECT_EQ(chooseWays(asked, 1, true, small).shadowLayers, 3u);
    RenderOptions maps = options(Shadows::opacityMaps);
    maps.shadowSlices = 16;
    EXPECT_EQ(chooseWays(maps, 1, true, small).shadowSlices, 7u);
    RenderOptions adaptive = options(Shadows::adaptive);
    adaptive.shadowNodes = 16;
    EXPECT_EQ(chooseWays(adaptive, 1, true, small).shadowNodes, 7u);
    const HairCount much{100'000, 1'000'000};
    EXPECT_EQ(fragmentsThatFit(adaptive, small, much), 64u * 64u * 4u * 7u / 12u);
    gpu::DeviceInfo large = small;
    large.maxBufferBytes = std::uint64_t{1} << 32u;
    EXPECT_EQ(fragmentsThatFit(adaptive, large, much), 1u << 22u) << "texels of small maps hold much hair";
    adaptive.shadowResolution = 1024;
    EXPECT_EQ(fragmentsThatFit(adaptive, large, much), 16u << 20u);
    adaptive.shadowResolution = 4096;
    EXPECT_EQ(fragmentsThatFit(adaptive, large, much), kMaxShadowFragments);
    // 200 strands of 3 segments, each cut into as many pieces as the options say: two texels across.
    EXPECT_EQ(fragmentsThatFit(adaptive, large, {200, 600}), 4u * (200 * 4096 + 600 * adaptive.subdivisions));
    EXPECT_EQ(fragmentsThatFit(adaptive, large, {1, 1}), kMinShadowFragments);
    large.memoryBytes = std::uint64_t{16} * 12'000'000;
    EXPECT_EQ(fragmentsThatFit(adaptive, large, much), 1'000'000u) << "a sixteenth of the memory";
    EXPECT_EQ(fragmentsThatFit(options(), large, much), 0u);
    for (RenderOptions* wrong : {&asked, &maps}) {
        wrong->shadowLayers = 12;
        EXPECT_FALSE(check(*wrong, small));
        wrong->shadowLayers = 3;
        wrong->shadowSlices = 0;
        EXPECT_FALSE(check(*wrong, small));
        wrong->shadowSlices = 4;
        wrong->shadowNodes = 17;
        EXPECT_FALSE(check(*wrong, small));
        wrong->shadowNodes = 8;
        wrong->shadowFragments = 1000;
        EXPECT_FALSE(check(*wrong, small));
        wrong->shadowFragments = kMaxShadowFragments;
        wrong->layerGrowth = 0.5f;
        EXPECT_FALSE(check(*wrong, small));
        wrong->layerGrowth = 2;
    }
}

TEST(RenderPlan, LayersEndWhereTheyAreAuthored) {
    for (const std::uint32_t count : {3u, 4u, 7u, 11u}) {
        for (const float growth : {0.0f, 1.0f, 1.5f, 2.0f, 8.0f}) {
            float before = 0, width = 0;
            for (std::uint32_t i = 0; i < count; ++i) {
                const float end = layerEnd(i, count, growth), now = end - before;
                EXPECT_GT(now, 0);
                if (growth >= 1 && i > 0) {
                    EXPECT_NEAR(now / width, growth, 0.02f * growth) << count << i;
                }
                width = now;
                before = end;
            }
            EXPECT_EQ(before, 1.0f) << count << growth;
        }
    }
    EXPECT_EQ(layerEnd(0, 3, 0), 0.04f);
    EXPECT_EQ(layerEnd(1, 3, 0), 0.14f);
    EXPECT_NEAR(layerEnd(1, 6, 0), 0.04f, 1e-6f);
}

TEST(RenderPlan, BytesAreThoseOfItsTargets) {
    SceneFacts facts = wholeScene();
    facts.shadowLights = 0;
    // Colour and depth with four samples, the resolved colour, the sum.
    EXPECT_EQ(planRender(facts, options(), 4).bytes(), 100u * 50u * (4u * (8u + 4u) + 8u + 16u));
    EXPECT_EQ(planRender(facts, options(), 1).bytes(), 100u * 50u * (8u + 4u + 16u));
    // Depth and light of four samples, the sum; no textures.
    RenderOptions kernels = options();
    kernels.ribbons = Ribbons::compute;
    EXPECT_EQ(planRender(facts, kernels, 4).bytes(), 100u * 50u * (4u * (4u + 4u) + 16u));
    facts.tableBytes = 1234;
    EXPECT_EQ(planRender(facts, kernels, 4).bytes(), 100u * 50u * (4u * (4u + 4u) + 16u) + 1234u);
    facts.tableBytes = 0;
    RenderOptions filtered = options();
    filtered.filter = PostFilter::fxaa;
    EXPECT_EQ(planRender(facts, filtered, 1).bytes(), 100u * 50u * (8u + 4u + 16u + 4u));
    facts.presents = false;
    EXPECT_FALSE(planRender(facts, filtered, 1).runs(Pass::filter));
    EXPECT_FALSE(planRender(facts, filtered, 1).has(TargetId::shown));
}

TEST(RenderPlan, BlurringShadowsHasAPassAndItsBytes) {
    RenderOptions blurred = options();
    const RenderPlan plain = planRender(wholeScene(), blurred, 1);
    EXPECT_FALSE(plain.runs(Pass::shadowBlur));
    blurred.shadowBlur = 2;
    const RenderPlan plan = planRender(wholeScene(), blurred, 1);
    EXPECT_TRUE(plan.runs(Pass::shadowBlur));
    EXPECT_EQ(plan.bytes() - plain.bytes(), 100u * 50u * 4u * 16u);
    blurred.shadows = Shadows::none;
    EXPECT_FALSE(planRender(wholeScene(), blurred, 1).runs(Pass::shadowBlur));
    EXPECT_FALSE(planRender(wholeScene(), blurred, 1).has(BufferId::blurred));
}

TEST(RenderPlan, MarkersAndBlendingCostOnlyWhenUsed) {
    SceneFacts facts = wholeScene();
    EXPECT_FALSE(planRender(facts, options(), 4).has(TargetId::overlayDepth));
    facts.overlayOnTop = true;
    EXPECT_FALSE(planRender(facts, options(), 4).has(TargetId::overlayDepth));
    facts.overlay = true;
    EXPECT_TRUE(planRender(facts, options(), 4).has(TargetId::overlayDepth));
    RenderOptions blended = options();
    EXPECT_FALSE(planRender(facts, blended, 4).has(TargetId::blendSum));
    blended.transparency = Transparency::weighted;
    EXPECT_TRUE(planRender(facts, blended, 4).runs(Pass::blend));
    EXPECT_TRUE(planRender(facts, blended, 4).has(TargetId::blendSumResolved));
    EXPECT_FALSE(planRender(facts, blended, 1).has(TargetId::blendSumResolved));
    facts.hair = false;
    EXPECT_FALSE(planRender(facts, blended, 4).has(TargetId::blendSum));
}

TEST(RenderPlan, SaysWhy) {
    for (const Shadows shadows : {Shadows::none, Shadows::deepOpacity, Shadows::absorption,
                                  Shadows::opacityMaps, Shadows::adaptive}) {
        for (int bits = 0; bits < 8; ++bits) {
            SceneFacts facts;
            facts.meshes = (bits & 1) != 0;
            facts.hair = (bits & 2) != 0;
            facts.shadowLights = facts.lights = (bits & 4) != 0 ? 1 : 0;
            const RenderPlan plan = planRender(facts, options(shadows), 4);
            for (const PlannedPass& pass : plan.passes) EXPECT_FALSE(pass.why.empty());
            for (const PlannedTarget& target : plan.targets) EXPECT_EQ(target.why.empty(), target.width == 0);
            for (const PlannedBuffer& buffer : plan.buffers) {
                EXPECT_EQ(buffer.why.empty(), buffer.elements == 0);
            }
            EXPECT_FALSE(plan.tables.why.empty());
        }
    }
    std::set<std::string> names;
    for (std::size_t i = 0; i < kPassCount; ++i) names.insert(passName(static_cast<Pass>(i)));
    EXPECT_EQ(names.size(), kPassCount);
    names.clear();
    for (std::size_t i = 0; i < kTargetCount; ++i) names.insert(targetName(static_cast<TargetId>(i)));
    EXPECT_EQ(names.size(), kTargetCount);
    names.clear();
    for (std::size_t i = 0; i < kBufferCount; ++i) names.insert(bufferName(static_cast<BufferId>(i)));
    EXPECT_EQ(names.size(), kBufferCount);
}

}  // namespace
}  // namespace hairloom::render
