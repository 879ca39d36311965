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
    const Image groundTruth = draw(PostFilter::none, 1, 64);
    const double rough = difference(draw(PostFilter::none, 1, 1), groundTruth);
    const double filtered = difference(draw(PostFilter::fxaa, 1, 1), groundTruth);
    const double high = difference(draw(PostFilter::fxaaHigh, 1, 1), groundTruth);
    const double many = difference(draw(PostFilter::none, device->info().maxSamples(), 1), groundTruth);
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

/// Shadows blurred in double precision: light without shadows times the ratio of the two means.
std::vector<double> blurredShadows(const LinearImage& shadowed, const LinearImage& lit, double deviation) {
    const auto width = static_cast<int>(lit.width), height = static_cast<int>(lit.height);
    const int reach = static_cast<int>(std::ceil(3 * deviation));
    const auto at = [width](int x, int y) { return static_cast<std::size_t>(4 * (y * width + x)); };
    std::vector<double> result;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            for (std::size_t c = 0; c < 3; ++c) {
                double a = 0, b = 0;
                for (int v = std::max(y - reach, 0); v <= std::min(y + reach, height - 1); ++v) {
                    for (int u = std::max(x - reach, 0); u <= std::min(x + reach, width - 1); ++u) {
                        const double away = (u - x) * (u - x) + (v - y) * (v - y);
                        const double weight = std::exp(-0.5 * away / (deviation * deviation));
                        a += weight * static_cast<double>(shadowed.rgba[at(u, v) + c]);
                        b += weight * static_cast<double>(lit.rgba[at(u, v) + c]);
                    }
                }
                result.push_back(b > 0 ? static_cast<double>(lit.rgba[at(x, y) + c]) * a / b : 0.0);
            }
        }
    }
    return result;
}

TEST_F(FilterTest, ShadowsAreBlurredAsOnTheCpu) {
    const TestHead head(200);
    RenderScene scene = head.scene();
    // Hair keeps light from around off its inside, which is no shadow of a light.
    scene.environment = Environment::gradient(Vec3f::Zero(), Vec3f::Zero());
    RenderOptions options;
    options.width = 40;
    options.height = 32;
    options.frames = 2;
    options.samples = 1;
    options.shadowResolution = 128;
    for (const Ribbons ribbons : {Ribbons::strip, Ribbons::compute}) {
        options.ribbons = ribbons;
        const auto draw = [&](Shadows shadows, float blur) {
            options.shadows = shadows;
            options.shadowBlur = blur;
            auto picture = renderPicture(*device, scene, options);
            EXPECT_TRUE(picture) << (picture ? "" : picture.error().message());
            return picture.value_or(Picture{});
        };
        const Picture shadowed = draw(Shadows::deepOpacity, 0);
        const Picture lit = draw(Shadows::none, 0);
        // Without shadows there are none to blur.
        EXPECT_EQ(draw(Shadows::none, 4).linear.rgba, lit.linear.rgba);
        for (const float blur : {0.7f, 3.0f}) {
            const Picture blurred = draw(Shadows::deepOpacity, blur);
            EXPECT_TRUE(blurred.plan.runs(Pass::shadowBlur));
            const auto groundTruth = blurredShadows(shadowed.linear, lit.linear, static_cast<double>(blur));
            double change = 0;
            for (std::size_t i = 0; i < groundTruth.size() / 3; ++i) {
                for (std::size_t c = 0; c < 3; ++c) {
                    const double found = static_cast<double>(blurred.linear.rgba[4 * i + c]);
                    ASSERT_NEAR(found, groundTruth[3 * i + c], 1e-4 + 1e-3 * groundTruth[3 * i + c])
                        << blur << " px, " << i;
                    change = std::max(change,
                                      std::abs(found - static_cast<double>(shadowed.linear.rgba[4 * i + c])));
                }
                EXPECT_EQ(blurred.linear.rgba[4 * i + 3], shadowed.linear.rgba[4 * i + 3]);
            }
            EXPECT_GT(change, 0.02) << "it blurs something";
        }
    }
}

}  // namespace
}  // namespace hairloom::render
