// SPDX-License-Identifier: GPL-3.0-or-later
// Hair blended as the nearest fragments of a pixel in their order, against closed forms and many passes.

#include "core/render/renderer.h"
#include "tests/render/pile.h"

namespace hairloom::render {
namespace {

class SortedTest : public RenderTest {
  protected:
    static RenderOptions options(std::uint32_t size, Transparency kind = Transparency::sorted,
                                 std::uint32_t frames = 1) {
        RenderOptions result;
        result.width = result.height = size;
        result.samples = 4;
        result.frames = frames;
        result.subdivisions = 1;
        result.shadowResolution = 256;
        result.transparency = kind;
        return result;
    }
    Picture draw(const RenderScene& scene, const RenderOptions& how) {
        auto picture = renderPicture(*device, scene, how);
        EXPECT_TRUE(picture) << (picture ? "" : picture.error().message());
        return picture ? std::move(*picture) : Picture();
    }
};

// In front of each other, light of single hairs and what they let through are those of their product.
TEST_F(SortedTest, HairIsBlendedInItsOrder) {
    constexpr float kCover = 0.4f;
    std::array<Vec3f, 3> alone;
    for (std::size_t k = 0; k < 3; ++k) {
        Pile one(k + 1, kCover);  // the last is alone once the others are taken away
        RenderStrands& view = one.scene.strands[0];
        const std::vector<std::uint32_t> offsets{static_cast<std::uint32_t>(3 * k),
                                                 static_cast<std::uint32_t>(3 * k + 3)};
        view.offsets = offsets;
        view.colours = view.colours.subspan(k, 1);
        RenderOptions how = options(Pile::kSize);
        how.shadows = Shadows::none;
        how.transparentBackground = true;
        const LinearImage image = draw(one.scene, how).linear;
        EXPECT_NEAR(luminanceAt(image, 16, 16, 3), kCover, 0.005);
        for (std::size_t c = 0; c < 3; ++c)
            alone[k][static_cast<Eigen::Index>(c)] = luminanceAt(image, 16, 16, c) / kCover;
    }
    for (const bool backwards : {false, true}) {
        const Pile three(3, kCover, backwards);
        RenderOptions how = options(Pile::kSize);
        how.shadows = Shadows::none;
        const LinearImage image = draw(three.scene, how).linear;
        for (std::size_t c = 0; c < 3; ++c) {
            float expected = 0, through = 1;
            for (const Vec3f& light : alone) {
                expected += through * kCover * light[static_cast<Eigen::Index>(c)];
                through *= 1 - kCover;
            }
            expected += through * 0.2f;
            EXPECT_NEAR(luminanceAt(image, 16, 16, c), expected, 0.01f * expected + 0.002f) << c;
        }
    }
}

// Hair behind the last fragment that is kept hides as much as it would.
TEST_F(SortedTest, MoreHairThanIsKeptHidesAsMuch) {
    for (const std::size_t count : {std::size_t{7}, std::size_t{20}, std::size_t{200}}) {
        const Pile pile(count, 0.1f);
        RenderOptions how = options(Pile::kSize);
        how.transparentBackground = true;
        const LinearImage image = draw(pile.scene, how).linear;
        EXPECT_NEAR(luminanceAt(image, 16, 16, 3), 1 - std::pow(0.9, count), 0.01) << count;
        // A pixel beside it has none: hair of a pixel's width ends within one.
        EXPECT_LT(luminanceAt(image, 16, 18, 3), 0.001f) << count;
    }
}

// Light that falls with depth, as it does into hair that is lit from before, falls on behind the last
// fragment that is kept.
TEST_F(SortedTest, MoreHairThanIsKeptIsAsDark) {
    expectDeepHairIsAsDark(
        options(Pile::kSize), 0.12f,
        [this](const RenderScene& scene, const RenderOptions& how) { return draw(scene, how).linear; });
}

TEST_F(SortedTest, OneFrameIsNearManyPasses) {
    const TestHead head(4000);
    for (const float thin : {1.0f, 0.35f}) {
        TestStrands strands = head.strands;
        for (float& radius : strands.radii) radius *= thin;
        RenderScene scene = head.scene();
        scene.strands = {strands.view()};
        scene.lights = studioLights(scene.camera);
        const Picture truth = draw(scene, options(128, Transparency::stochastic, 96));
        const Picture sorted = draw(scene, options(128));
        const double found = decibels(sorted.image, truth.image);
        EXPECT_GT(found, 36) << thin;
        EXPECT_GT(found,
                  decibels(draw(scene, options(128, Transparency::stochastic)).image, truth.image) + 3);
        // Hairs beside each other in a pixel count as if they lay at random there: more skin shows than does.
        const double light = meanLuminance(truth.linear);
        EXPECT_NEAR(meanLuminance(sorted.linear), light, 0.035 * light) << thin;
    }
}

TEST_F(SortedTest, TheOrderOfStrandsDoesNotShow) {
    const TestHead head(800);
    RenderScene scene = head.scene();
    const Image one = draw(scene, options(96)).image;
    EXPECT_EQ(draw(scene, options(96)).image.rgba, one.rgba);
    TestStrands turned;
    const auto& offsets = head.strands.offsets;
    for (std::size_t s = offsets.size() - 1; s-- > 0;) {
        for (std::uint32_t p = offsets[s]; p < offsets[s + 1]; ++p) {
            turned.positions.push_back(head.strands.positions[p]);
            turned.radii.push_back(head.strands.radii[p]);
        }
        turned.offsets.push_back(static_cast<std::uint32_t>(turned.positions.size()));
    }
    scene.strands = {turned.view()};
    scene.strands[0].material.variation = 0;
    RenderScene straight = head.scene();
    straight.strands[0].material.variation = 0;
    // Each strand's own chance stays with its number: light differs, what is covered does not.
    RenderOptions how = options(96);
    how.transparentBackground = true;
    const LinearImage a = draw(straight, how).linear, b = draw(scene, how).linear;
    for (std::size_t i = 3; i < a.rgba.size(); i += 4) ASSERT_NEAR(a.rgba[i], b.rgba[i], 1e-3f) << i;
}

TEST_F(SortedTest, TheHeadHidesHairBehindIt) {
    Pile pile(12, 1);
    const std::vector<Vec3f> corners{{-2, -2, -0.009f}, {0, -2, -0.009f}, {0, 2, -0.009f}, {-2, 2, -0.009f}};
    const std::vector<std::uint32_t> indices{0, 1, 2, 0, 2, 3};
    RenderMesh wall;
    wall.positions_ws = corners;
    wall.indices = indices;
    wall.matte = true;
    wall.albedo = Vec3f::Zero();
    for (std::size_t i = 0; i < 5; ++i) pile.colours[i] = Vec3f::Zero();
    pile.scene.strands[0].material.primary = Vec3f::Zero();
    pile.scene.meshes = {wall};
    pile.scene.lights = studioLights(pile.scene.camera);
    const LinearImage image = draw(pile.scene, options(Pile::kSize)).linear;
    // To the left black hair stands before a black wall; to the right the other hair shines through nothing.
    EXPECT_LT(luminanceAt(image, 8, 16, 0), 0.01f);
    EXPECT_LT(luminanceAt(image, 8, 16, 1), 0.01f);
    const LinearImage without = [&] {
        pile.scene.meshes.clear();
        return draw(pile.scene, options(Pile::kSize)).linear;
    }();
    EXPECT_NEAR(luminanceAt(image, 24, 16, 1), luminanceAt(without, 24, 16, 1), 0.02f);
}

TEST_F(SortedTest, WhatCannotBeSortedIsSaid) {
    const TestHead head(10);
    for (const Ribbons ribbons : {Ribbons::strip, Ribbons::tessellated}) {
        RenderOptions how = options(16);
        how.ribbons = ribbons;
        EXPECT_FALSE(renderPicture(*device, head.scene(), how)) << static_cast<int>(ribbons);
    }
    // Round strands are shaded a pixel at a time.
    RenderScene scene = head.scene();
    scene.strands[0].material.tubes = true;
    EXPECT_TRUE(renderPicture(*device, scene, options(16)));
}

TEST(ChooseWays, FollowsDeviceAndPicture) {
    gpu::DeviceInfo gpu, software;
    gpu.type = gpu::DeviceType::Discrete;
    software.type = gpu::DeviceType::Cpu;
    gpu.maxBufferBytes = software.maxBufferBytes = std::uint64_t{1} << 30u;
    const auto chosen = [](RenderOptions options, const gpu::DeviceInfo& device, bool kernels = true) {
        options.transparency = Transparency::automatic;
        const RenderOptions ways = chooseWays(options, 4, kernels, device);
        return std::pair(ways.transparency, ways.ribbons);
    };
    using Ways = std::pair<Transparency, Ribbons>;
    RenderOptions still;
    RenderOptions single;
    single.frames = 1;
    RenderOptions moving = single;
    moving.temporal = true;
    EXPECT_EQ(chosen(still, gpu), Ways(Transparency::stochastic, Ribbons::compute));
    EXPECT_EQ(chosen(single, gpu), Ways(Transparency::sorted, Ribbons::compute));
    EXPECT_EQ(chosen(moving, gpu), Ways(Transparency::sorted, Ribbons::compute));
    EXPECT_EQ(chosen(still, software), Ways(Transparency::stochastic, Ribbons::strip));
    EXPECT_EQ(chosen(single, software), Ways(Transparency::weighted, Ribbons::strip));
    EXPECT_EQ(chosen(moving, software), Ways(Transparency::stochastic, Ribbons::strip));
    EXPECT_EQ(chosen(single, gpu, false), Ways(Transparency::weighted, Ribbons::strip));
    RenderOptions strips = single;
    strips.ribbons = Ribbons::strip;
    EXPECT_EQ(chosen(strips, gpu), Ways(Transparency::weighted, Ribbons::strip));
    RenderOptions kernels = single;
    kernels.ribbons = Ribbons::compute;
    EXPECT_EQ(chosen(kernels, software), Ways(Transparency::sorted, Ribbons::compute));
    gpu.maxBufferBytes = 1 << 20u;  // too small for eight fragments a pixel
    EXPECT_EQ(chosen(single, gpu), Ways(Transparency::weighted, Ribbons::strip));
}

}  // namespace
}  // namespace hairloom::render
