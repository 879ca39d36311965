// SPDX-License-Identifier: GPL-3.0-or-later
// Light from around, from OpenEXR files to pixels, against closed forms and the double-precision model.
#include "core/render/environment.h"

#include <cstdio>
#include <filesystem>
#include <functional>

#include "core/base/file.h"
#include "core/render/exr.h"
#include "core/shading/dual_scattering.h"
#include "core/shading/melanin.h"
#include "tests/render/render_fixture.h"

namespace hairloom::render {
namespace {

const std::filesystem::path kFile = std::filesystem::path(testing::TempDir()) / "hairloom-environment.exr";
constexpr double kCircle = 2 * 3.14159265358979323846;

LinearImage lit(std::uint32_t width, std::uint32_t height,
                const std::function<Vec3f(std::uint32_t, std::uint32_t)>& light) {
    LinearImage image{width, height, {}};
    for (std::uint32_t y = 0; y < height; ++y) {
        for (std::uint32_t x = 0; x < width; ++x) {
            const Vec3f rgb = light(x, y);
            image.rgba.insert(image.rgba.end(), {rgb.x(), rgb.y(), rgb.z(), 1.0f});
        }
    }
    return image;
}

TEST(Exr, ComesBackAsItWent) {
    Random random(3);
    const LinearImage image = lit(37, 19, [&](auto, auto) {
        return Vec3f(random.uniform(0, 500), random.uniform(), -random.uniform());
    });
    ASSERT_TRUE(writeExr(kFile, image));
    const auto read = readExr(kFile);
    ASSERT_TRUE(read) << read.error().message();
    EXPECT_EQ(read->width, 37u);
    EXPECT_EQ(read->height, 19u);
    EXPECT_EQ(read->rgba, image.rgba);
    std::filesystem::remove(kFile);
}

TEST(Exr, DamagedFilesAreErrors) {
    ASSERT_TRUE(writeExr(kFile, lit(16, 8, [](auto x, auto y) {
                             return Vec3f(static_cast<float>(x), static_cast<float>(y), 1);
                         })));
    const auto whole = readFile(kFile).value();
    for (std::size_t length = 0; length < whole.size(); length += 7) {
        ASSERT_TRUE(writeFileAtomically(kFile, std::span(whole).first(length)));
        EXPECT_FALSE(readExr(kFile)) << length << " of " << whole.size() << " bytes";
    }
    ASSERT_TRUE(writeFileAtomically(kFile, std::string_view("no picture")));
    EXPECT_FALSE(readExr(kFile));
    std::filesystem::remove(kFile);
    EXPECT_FALSE(readExr(kFile));
}

TEST(Environment, AnEvenSkyFromAFileIsOneRadiance) {
    const Vec3f sky(12.5f, 3, 0.25f);
    ASSERT_TRUE(writeExr(kFile, lit(128, 64, [&](auto, auto) { return Vec3f(sky); })));
    const auto image = readExr(kFile);
    ASSERT_TRUE(image) << image.error().message();
    const auto environment = Environment::fromImage(*image);
    ASSERT_TRUE(environment);
    Random random(2);
    for (int i = 0; i < 20; ++i) {
        const Vec3f d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
        EXPECT_TRUE(environment->radiance(d).isApprox(sky, 2e-3f));
    }
    std::filesystem::remove(kFile);
}

/// A fibre that fills the middle of a small picture, under light from around alone.
class FibreUnderSky : public RenderTest {
  protected:
    FibreUnderSky() {
        marschner.azimuthal.width = shading::azimuthalWidth(0.3);
        marschner.azimuthal.causticWidth = 0;
        shading::setScales(marschner, 2 * shading::kDegree, shading::longitudinalWidth(0.3));
    }

    /// Light towards the camera, which looks along -z, from a fibre in the plane of the picture turned by
    /// `roll` and leaning towards the camera by `lean`, radians.
    Vec3d pixel(const Environment& environment, float roll, float lean) {
        const Vec3f along = alongOf(roll, lean);
        TestStrands strands;
        strands.add({-0.2f * along, -0.1f * along, Vec3f::Zero(), 0.1f * along, 0.2f * along}, 0.06f);
        RenderScene scene;
        scene.strands = {strands.view()};
        HairMaterial& material = scene.strands[0].material;
        material.variation = 0;
        material.rootBrightness = material.tipBrightness = 1;
        material.fibre.model = ShadingModel::marschner;
        material.fibre.scattering = Scattering::single;
        material.fibre.marschner = marschner;
        scene.environment = environment;
        scene.background = Vec3f::Zero();
        scene.camera.eye_ws = {0, 0, 4};
        scene.camera.target_ws = Vec3f::Zero();
        scene.camera.verticalFov = 1;
        RenderOptions options;
        options.width = options.height = 8;
        options.samples = 1;
        options.frames = 1;
        const auto picture = renderPicture(*device, scene, options);
        EXPECT_TRUE(picture) << (picture ? "" : picture.error().message());
        if (!picture) return Vec3d::Zero();
        const float* rgba = &picture->linear.rgba[4 * (8 * 4 + 4)];
        return Vec3f(rgba[0], rgba[1], rgba[2]).cast<double>();
    }
    static Vec3f alongOf(float roll, float lean) {
        return {std::cos(roll) * std::cos(lean), std::sin(roll) * std::cos(lean), std::sin(lean)};
    }

    /// ∫ S cos θ_i L dω of the model itself: stratified Monte-Carlo, θ_i by strata, all azimuths.
    Vec3d traced(const std::function<Vec3d(const Vec3d&)>& sky, float roll, float lean) const {
        constexpr int kStrata = 240, kAzimuths = 96;
        const shading::Marschner model(marschner);
        const Vec3d along = alongOf(roll, lean).cast<double>();
        const Vec3d toView = Vec3d::UnitZ();
        const double thetaOut = std::asin(std::clamp(toView.dot(along), -1.0, 1.0));
        const Vec3d front = (toView - toView.dot(along) * along).normalized();
        const Vec3d side = along.cross(front);
        Random random(9);
        Vec3d sum = Vec3d::Zero();
        for (int i = 0; i < kStrata; ++i) {
            // Even in sin θ is even over the sphere.
            const double sine = 2 * (i + random.uniformDouble()) / kStrata - 1;
            const double thetaIn = std::asin(sine);
            const double cosine = std::cos(thetaIn);
            const double thetaD = 0.5 * (thetaOut - thetaIn);
            const double cosD = std::max(std::cos(thetaD), 1e-6);
            const auto grid = model.azimuthal(thetaD).grid();
            for (int k = 0; k < kAzimuths; ++k) {
                const double phi = kCircle * (k + random.uniformDouble()) / kAzimuths;
                const double folded = std::abs(shading::wrapAngle(phi)) / (kCircle / 2) *
                                      static_cast<double>(shading::AzimuthalProfile::kGridSize - 1);
                const auto at = static_cast<std::size_t>(std::lround(folded));
                Vec3d s = Vec3d::Zero();
                for (int c = 0; c < 3; ++c) {
                    const auto channel = static_cast<std::size_t>(c);
                    s[c] = model.longitudinal(shading::Lobe::R, thetaIn, thetaOut) *
                               static_cast<double>(grid.r[at]) +
                           model.longitudinal(shading::Lobe::TT, thetaIn, thetaOut) *
                               static_cast<double>(grid.tt[channel][at]) +
                           model.longitudinal(shading::Lobe::TRT, thetaIn, thetaOut) *
                               static_cast<double>(grid.trt[channel][at]);
                }
                const Vec3d d = sine * along + cosine * (std::cos(phi) * front + std::sin(phi) * side);
                sum += s.cwiseProduct(sky(d)) * (cosine / (cosD * cosD));
            }
        }
        return sum * (2 * kCircle / (kStrata * kAzimuths));
    }

    shading::MarschnerParameters marschner;
};

TEST_F(FibreUnderSky, AnEvenSkyGivesTheClosedForm) {
    const Environment even = Environment::gradient(Vec3f::Constant(2), Vec3f::Constant(2));
    for (const double eumelanin : {0.0, 0.3, 1.3, 8.0}) {
        marschner.azimuthal.absorption = shading::absorption({eumelanin, 0});
        // What a fibre sends out of what it gets from everywhere, over all directions: closed over the
        // sphere.
        const Vec3d expected = 2 * shading::DualScattering(shading::Marschner(marschner)).meanAlbedo();
        const Vec3d seen = pixel(even, 0.4f, 0.3f);
        EXPECT_TRUE(seen.isApprox(expected, 0.004)) << eumelanin << ": " << seen.transpose();
        if (eumelanin == 0) {
            EXPECT_LT(seen.maxCoeff(), 2) << "no fibre shines";
            EXPECT_GT(seen.minCoeff(), 2 * 0.94) << "without absorption nearly all comes back";
        }
    }
}

TEST_F(FibreUnderSky, RatioToBruteForceOnSomePixels) {
    // Skies of one brighter side, seen from all around: what a pixel shows over what the model traces.
    double worst = 0, sum = 0;
    int count = 0;
    for (const double eumelanin : {0.3, 1.3}) {
        marschner.azimuthal.absorption = shading::absorption({eumelanin, 0});
        for (int view = 0; view < 6; ++view) {
            const auto roll = static_cast<float>(view) * 1.1f,
                       lean = 0.25f * static_cast<float>(view % 3 - 1);
            const Environment even = Environment::gradient(Vec3f::Constant(1), Vec3f::Constant(1));
            const Environment sky = Environment::gradient(Vec3f(0.9f, 1, 1.2f), Vec3f(0.5f, 0.45f, 0.4f));
            const auto radiance = [&](const Vec3d& d) {
                return Vec3d(sky.radiance(d.cast<float>()).cast<double>());
            };
            const Vec3d ours = pixel(sky, roll, lean), truth = traced(radiance, roll, lean);
            const double ratio = ours.sum() / truth.sum();
            worst = std::max(worst, std::abs(ratio - 1));
            sum += ratio;
            ++count;
            const auto flat = [](const Vec3d&) { return Vec3d(Vec3d::Ones()); };
            const double evenRatio = pixel(even, roll, lean).sum() / traced(flat, roll, lean).sum();
            std::printf("eumelanin %.1f, roll %.1f, lean %.2f: sky %.3f, even %.3f\n", eumelanin,
                        static_cast<double>(roll), static_cast<double>(lean), ratio, evenRatio);
            EXPECT_NEAR(evenRatio, 1, 0.04);
        }
    }
    RecordProperty("mean_ratio", std::to_string(sum / count));
    RecordProperty("worst", std::to_string(worst));
    // Measured: 1.19 on average, 1.07 to 1.31. The shader adds to a fibre some of the brighter side, as
    // fibres near the surface of much hair see it (lights.hlsli, openToIt); a fibre by itself gets too much
    // of it.
    EXPECT_NEAR(sum / count, 1.19, 0.04);
    EXPECT_LT(worst, 0.35);
}

}  // namespace
}  // namespace hairloom::render
