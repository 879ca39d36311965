// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/render/plan.h"

#include <gtest/gtest.h>

#include <set>

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
    // What counts them is there for one light after the other.
    EXPECT_EQ(deep.buffer(BufferId::layerCounts).bytes(), 64u * 64u * 3u * 4u);
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
    for (const Shadows shadows :
         {Shadows::none, Shadows::deepOpacity, Shadows::absorption, Shadows::opacityMaps}) {
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
