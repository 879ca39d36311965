// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/render/render_fixture.h"

namespace hairloom::render {
namespace {

class FilterTest : public RenderTest {
  protected:
    /// A triangle with slanted edges.
    Image draw(PostFilter filter, std::uint32_t samples, std::uint32_t frames) {
        const std::vector<Vec3f> corners = {{-0.15f, -0.16f, 0}, {0.17f, -0.1f, 0}, {0.02f, 0.16f, 0}};
        const std::vector<std::uint32_t> indices = {0, 1, 2};
        RenderScene scene;
        RenderMesh mesh;
        mesh.positions_ws = corners;
        mesh.indices = indices;
        mesh.albedo = Vec3f::Ones();
        scene.meshes = {mesh};
        scene.environment = Environment::gradient(Vec3f::Ones(), Vec3f::Ones());
        scene.background = Vec3f::Zero();
        scene.camera.eye_ws = {0, 0, 1};
        scene.camera.target_ws = {0, 0, 0};
        RenderOptions options;
        options.width = options.height = 96;
        options.samples = samples;
        options.frames = frames;
        options.filter = filter;
        const auto picture = renderPicture(*device, scene, options);
        EXPECT_TRUE(picture) << (picture ? "" : picture.error().message());
        return picture ? picture->image : Image{};
    }
    static double difference(const Image& a, const Image& b) {
        double sum = 0;
        for (std::size_t i = 0; i < a.rgba.size(); ++i) {
            const double d = static_cast<double>(a.rgba[i]) - static_cast<double>(b.rgba[i]);
            sum += d * d;
        }
        return std::sqrt(sum / static_cast<double>(a.rgba.size()));
    }
};

TEST_F(FilterTest, SmoothEdgesComeNearerToManySamples) {
    const Image truth = draw(PostFilter::none, 1, 64);
    const double rough = difference(draw(PostFilter::none, 1, 1), truth);
    const double filtered = difference(draw(PostFilter::fxaa, 1, 1), truth);
    const double high = difference(draw(PostFilter::fxaaHigh, 1, 1), truth);
    const double many = difference(draw(PostFilter::none, device->info().maxSamples(), 1), truth);
    EXPECT_LT(filtered, 0.8 * rough);
    EXPECT_LT(high, 0.8 * rough);
    EXPECT_LT(many, 0.8 * rough);
    EXPECT_NEAR(high, filtered, 0.1 * filtered);
}

TEST_F(FilterTest, EvenPicturesStayAsTheyAre) {
    RenderScene scene;
    RenderOptions options;
    options.width = 33;
    options.height = 21;
    const auto plain = renderPicture(*device, scene, options);
    options.filter = PostFilter::fxaaHigh;
    const auto filtered = renderPicture(*device, scene, options);
    ASSERT_TRUE(plain);
    ASSERT_TRUE(filtered);
    EXPECT_EQ(plain->image.rgba, filtered->image.rgba);
}

}  // namespace
}  // namespace hairloom::render
