// SPDX-License-Identifier: GPL-3.0-or-later
// Light from around, from OpenEXR files to pixels, against closed forms and the double-precision model.
#include "core/render/environment.h"

#include <filesystem>
#include <functional>

#include "core/base/file.h"
#include "core/render/exr.h"
#include "core/shading/marschner.h"
#include "core/shading/melanin.h"
#include "tests/render/render_fixture.h"
#include "tests/support/temporary_folder.h"

namespace hairloom::render {
namespace {

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
    const TemporaryFolder folder;
    const auto file = folder / "sky.exr";
    Random random(3);
    const LinearImage image = lit(37, 19, [&](auto, auto) {
        return Vec3f(random.uniform(0, 500), random.uniform(), -random.uniform());
    });
    ASSERT_TRUE(writeExr(file, image));
    const auto read = readExr(file);
    ASSERT_TRUE(read) << read.error().message();
    EXPECT_EQ(read->width, 37u);
    EXPECT_EQ(read->height, 19u);
    EXPECT_EQ(read->rgba, image.rgba);
}

TEST(Exr, DamagedFilesAreErrors) {
    const TemporaryFolder folder;
    const auto file = folder / "sky.exr";
    ASSERT_TRUE(writeExr(file, lit(16, 8, [](auto x, auto y) {
                             return Vec3f(static_cast<float>(x), static_cast<float>(y), 1);
                         })));
    const auto whole = readFile(file).value();
    for (std::size_t length = 0; length < whole.size(); length += 7) {
        ASSERT_TRUE(writeFileAtomically(file, std::span(whole).first(length), Replacing::Anything));
        EXPECT_FALSE(readExr(file)) << length << " of " << whole.size() << " bytes";
    }
    // Nothing is lost or put in unseen.
    for (std::size_t at = 0; at < whole.size(); at += 5) {
        std::vector<std::byte> less = whole, more = whole;
        less.erase(less.begin() + static_cast<std::ptrdiff_t>(at));
        more.insert(more.begin() + static_cast<std::ptrdiff_t>(at), 3, std::byte{'n'});
        EXPECT_FALSE(decodeExr("less", less)) << at;
        EXPECT_FALSE(decodeExr("more", more)) << at;
    }
    ASSERT_TRUE(writeFileAtomically(file, std::as_bytes(std::span(std::string_view("no picture"))),
                                    Replacing::Anything));
    EXPECT_FALSE(readExr(file));
    EXPECT_FALSE(readExr(file));
}

TEST(Environment, AnEvenSkyFromAFileIsOneRadiance) {
    const TemporaryFolder folder;
    const auto file = folder / "sky.exr";
    const Vec3f sky(12.5f, 3, 0.25f);
    ASSERT_TRUE(writeExr(file, lit(128, 64, [&](auto, auto) { return Vec3f(sky); })));
    const auto image = readExr(file);
    ASSERT_TRUE(image) << image.error().message();
    const auto environment = Environment::fromImage(*image);
    ASSERT_TRUE(environment);
    Random random(2);
    for (int i = 0; i < 20; ++i) {
        const Vec3f d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
        EXPECT_TRUE(environment->radiance(d).isApprox(sky, 2e-3f));
    }
}

/// Skies as Environment::gradient() has them, brighter above.
const Environment kEven = Environment::gradient(Vec3f::Constant(1), Vec3f::Constant(1));
const Environment kSky = Environment::gradient(Vec3f(0.9f, 1, 1.2f), Vec3f(0.5f, 0.45f, 0.4f));

using Sky = std::function<Vec3d(const Vec3d&)>;
Sky radianceOf(const Environment& environment) {
    return
        [environment](const Vec3d& d) { return Vec3d(environment.radiance(d.cast<float>()).cast<double>()); };
}

/// A layer of parallel fibres across x, lit and seen from its normal, which is turned from straight up by
/// `tilt`.
struct Layer {
    static constexpr double kFibres = 4;  ///< that a ray along the normal meets
    Vec3f normal;
    TestStrands strands;

    explicit Layer(float tilt) : normal(0, std::cos(tilt), std::sin(tilt)) {
        constexpr float kRadius = 0.0002f, kSide = 0.15f;
        const Vec3f across(0, -std::sin(tilt), std::cos(tilt));
        Random random(5);
        for (int i = 0; i < static_cast<int>(kFibres * 2 * kSide / (2 * kRadius)); ++i) {
            const Vec3f middle =
                random.uniform(-0.03f, 0.03f) * normal + random.uniform(-kSide, kSide) * across;
            const Vec3f half = kSide * Vec3f::UnitX(), seen = 0.03f * Vec3f::UnitX();
            strands.add({middle - half, middle - seen, middle, middle + seen, middle + half}, kRadius);
        }
    }

    /// Light from d as fibres of a layer without end get it, the mean of those that are seen.
    Vec3d seenBy(const Vec3d& d, const Sky& sky) const {
        const double up = d.dot(normal.cast<double>());
        const double path = std::hypot(up, d.dot(normal.cast<double>().cross(Vec3d::UnitX()))) /
                            std::max(std::abs(up), 1e-6);  // fibres met by those across
        const double shown = 1 - std::exp(-kFibres);
        const double passed = up > 0 ? (1 - std::exp(-kFibres * (1 + path))) / (1 + path)
                              : std::abs(path - 1) < 1e-6
                                  ? kFibres * std::exp(-kFibres)
                                  : (std::exp(-kFibres) - std::exp(-kFibres * path)) / (path - 1);
        return passed / shown * sky(d);
    }
};

/// Hair in the middle of a small picture, under light from around alone.
class HairUnderSky : public RenderTest {
  protected:
    HairUnderSky() {
        marschner.azimuthal.width = shading::azimuthalWidth(0.3);
        marschner.azimuthal.causticWidth = 0;
        shading::setScales(marschner, 2 * shading::kDegree, shading::longitudinalWidth(0.3));
    }

    /// Mean of a picture of strands alone from `eye_ws`.
    Vec3d picture(const TestStrands& strands, const Environment& environment, const Vec3f& eye_ws,
                  std::uint32_t frames = 1, Shadows shadows = Shadows::deepOpacity) {
        RenderScene scene;
        scene.strands = {strands.view()};
        StrandShading& material = scene.strands[0].material;
        material.variation = 0;
        material.rootBrightness = material.tipBrightness = 1;
        material.fibre.model = ShadingModel::marschner;
        material.fibre.scattering = scattering;
        material.fibre.marschner = marschner;
        scene.environment = environment;
        scene.background = Vec3f::Zero();
        scene.camera.eye_ws = eye_ws;
        scene.camera.target_ws = Vec3f::Zero();
        scene.camera.up_ws = Vec3f(0.1f, 1, 0.2f).normalized();
        scene.camera.verticalFov = 1;
        RenderOptions options;
        options.width = options.height = 8;
        options.samples = 1;
        options.frames = frames;
        options.shadows = shadows;
        const auto drawn = renderPicture(*device, scene, options);
        EXPECT_TRUE(drawn) << (drawn ? "" : drawn.error().message());
        return drawn ? meanColour(drawn->linear) : Vec3d(Vec3d::Zero());
    }

    /// ∫ S cos θ_i L dω of the model itself: stratified Monte-Carlo, θ_i by strata, all azimuths.
    Vec3d traced(const Sky& sky, const Vec3d& along, const Vec3d& toView) const {
        constexpr int kStrata = 120, kAzimuths = 96;
        const shading::Marschner model(marschner);
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

    /// Seen along its normal.
    Vec3d layerUnder(const Layer& layer, const Environment& environment) {
        return picture(layer.strands, environment, 2 * layer.normal, 24);
    }

    shading::MarschnerParameters marschner;
    Scattering scattering = Scattering::single;
};

TEST_F(HairUnderSky, ALoneFibreShowsTheModelsIntegralOverTheSky) {
    double worst = 0;
    for (const double eumelanin : {0.0, 0.3, 1.3}) {
        marschner.azimuthal.absorption = shading::absorption({eumelanin, 0});
        for (int view = 0; view < 6; ++view) {
            const auto roll = static_cast<float>(view) * 1.1f, lean = 0.5f * static_cast<float>(view % 3 - 1);
            const Vec3f along(std::cos(roll) * std::cos(lean), std::sin(roll) * std::cos(lean),
                              std::sin(lean));
            TestStrands strands;
            strands.add({-0.2f * along, -0.1f * along, Vec3f::Zero(), 0.1f * along, 0.2f * along}, 0.06f);
            for (const Environment& environment : {kEven, kSky}) {
                const Vec3d ours = picture(strands, environment, {0, 0, 4}, 1, Shadows::none);
                const Vec3d groundTruth =
                    traced(radianceOf(environment), along.cast<double>(), Vec3d::UnitZ());
                const double ratio = ours.sum() / groundTruth.sum();
                worst = std::max(worst, std::abs(ratio - 1));
                EXPECT_NEAR(ratio, 1, 0.04) << eumelanin << " roll " << roll << " lean " << lean;
                EXPECT_LT(ours.maxCoeff(), 1.2) << "no fibre shines";
            }
        }
    }
    RecordProperty("worst", std::to_string(worst));
}

TEST_F(HairUnderSky, DenseHairShowsItsOpenSide) {
    // Black, for others show little of it that is not scattered more than once.
    marschner.azimuthal.absorption = shading::absorption({8, 0});
    const std::vector<float> tilts{0.0f, 0.4f, 0.8f, 1.2f, 1.6f, 2.0f, 2.4f, 2.8f};
    double mean = 0;
    for (const float tilt : tilts) {
        const Layer layer(tilt);
        const Sky sky = radianceOf(kSky);
        const Vec3d ours = layerUnder(layer, kSky) / (1 - std::exp(-Layer::kFibres));
        const Vec3d groundTruth = traced([&](const Vec3d& d) { return layer.seenBy(d, sky); }, Vec3d::UnitX(),
                                         layer.normal.cast<double>());
        // Twelve directions see an edge without end differently as it turns.
        const double ratio = ours.sum() / groundTruth.sum();
        EXPECT_NEAR(ratio, 1.08, 0.2) << "tilt " << tilt;
        mean += ratio / static_cast<double>(tilts.size());
    }
    // Fibres at random places leave more gaps than their mean.
    EXPECT_NEAR(mean, 1.1, 0.08);
    RecordProperty("mean", std::to_string(mean));
}

TEST_F(HairUnderSky, WhiteHairIsAsBrightAsAnEvenSky) {
    scattering = Scattering::dual;
    marschner.azimuthal.absorption.setZero();
    const Vec3d seen = layerUnder(Layer(0.4f), kEven) / (1 - std::exp(-Layer::kFibres));
    // Orders that the model leaves out take 1 % at each scattering.
    EXPECT_LT(seen.maxCoeff(), 1.02);
    EXPECT_GT(seen.minCoeff(), 0.88);
}

}  // namespace
}  // namespace hairloom::render
