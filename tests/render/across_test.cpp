// SPDX-License-Identifier: GPL-3.0-or-later
// Hair wider than a pixel: light over its width.
#include <numbers>

#include "core/render/renderer.h"
#include "core/shading/marschner.h"
#include "core/software/device.h"
#include "shaders/shared/render_types.h"
#include "tests/render/render_fixture.h"

namespace hairloom::render {
namespace {

constexpr float kFibreRadius = 0.0004f;  // metres
constexpr std::uint32_t kRowSize = 64;

/// Marschner's fibre upright in the middle, `pixels` wide, in the light of one lamp at an azimuth against the
/// view.
struct Fibre {
    TestStrands strands;
    RenderScene scene;

    explicit Fibre(float pixels, float azimuth = 0.9f, float height = 0.3f) {
        strands.add({Vec3f(0, -0.4f, 0), Vec3f(0, -0.1f, 0), Vec3f(0, 0.1f, 0), Vec3f(0, 0.4f, 0)},
                    kFibreRadius);
        scene.strands = {strands.view()};
        StrandShading& material = scene.strands[0].material;
        material.variation = 0;
        material.rootBrightness = material.tipBrightness = 1;
        material.albedo = material.fibreColour = Vec3f::Ones();
        FibreMaterial& fibre = material.fibre;
        fibre.model = ShadingModel::marschner;
        fibre.scattering = Scattering::single;
        fibre.marschner.azimuthal.width = 0.25;
        fibre.marschner.azimuthal.absorption = Vec3d(0.1, 0.2, 0.4);
        scene.camera.eye_ws = Vec3f(0, 0, 1);
        scene.camera.target_ws = Vec3f::Zero();
        scene.camera.orthographicHeight = 2 * kFibreRadius * static_cast<float>(kRowSize) / pixels;
        scene.environment = {};
        Light light;
        light.toLight_ws = Vec3f(std::sin(azimuth), height, std::cos(azimuth));
        light.castsShadow = false;
        scene.lights = {light};
    }
};

RenderOptions acrossOptions() {
    RenderOptions result;
    result.width = result.height = kRowSize;
    result.frames = 16;
    result.transparentBackground = true;
    return result;
}

class AcrossTest : public RenderTest {
  protected:
    LinearImage draw(const RenderScene& scene, const RenderOptions& how) {
        auto picture = renderPicture(*device, scene, how);
        EXPECT_TRUE(picture) << (picture ? "" : picture.error().message());
        return picture ? std::move(picture->linear) : LinearImage{};
    }
    /// Light of the middle row, summed over it and by the pixels that a hair is wide.
    static Vec3d lightOf(const LinearImage& image, double pixels) {
        Vec3d sum = Vec3d::Zero();
        for (std::size_t x = 0; x < kRowSize; ++x) sum += pixel(image, x);
        return sum / pixels;
    }
    static Vec3d pixel(const LinearImage& image, std::size_t x) {
        const float* const p = &image.rgba[4 * (std::size_t{kRowSize / 2} * kRowSize + x)];
        return Vec3f(p[0], p[1], p[2]).cast<double>();
    }
};

/// What leaves a section at an offset to the side of the camera's ray: single rays by the optics of the
/// reference, each spread by the fibre's roughness. Each path has in the mean what the model has, whose
/// caustics are smoothed.
class Section {
  public:
    explicit Section(const Fibre& fibre)
        : parameters_(fibre.scene.strands[0].material.fibre.marschner), model_(parameters_) {
        const Vec3d toLight = fibre.scene.lights[0].toLight_ws.cast<double>().normalized();
        thetaIn_ = std::asin(toLight.y());
        phi_ = std::atan2(toLight.x(), toLight.z());
        irradiance_ = static_cast<double>(fibre.scene.lights[0].irradiance.x());
        for (const shading::Lobe lobe : shading::kLobes) {
            constexpr int kRays = 4000;
            Vec3d mean = Vec3d::Zero();
            for (int i = 0; i < kRays; ++i) mean += ray(lobe, 2 * (i + 0.5) / kRays - 1) / kRays;
            scale_[shading::index(lobe)] = model_.azimuthal(thetaD())(lobe, phi_).cwiseQuotient(mean);
        }
    }
    Vec3d light(double side) const {
        Vec3d sum = Vec3d::Zero();
        for (const shading::Lobe lobe : shading::kLobes)
            sum += model_.longitudinal(lobe, thetaIn_, 0) *
                   ray(lobe, side).cwiseProduct(scale_[shading::index(lobe)]);
        return sum * (irradiance_ * std::cos(thetaIn_) / std::pow(std::cos(thetaD()), 2));
    }

    /// As the cells of the width have it, averaged over as much as one of them.
    Vec3d seen(double side) const {
        constexpr int kSteps = 8 * HAIRLOOM_ACROSS_CELLS;
        constexpr double kCell = 2.0 / HAIRLOOM_ACROSS_CELLS;
        Vec3d sum = Vec3d::Zero();
        double count = 0;
        for (int i = 0; i < kSteps; ++i) {
            const double at = side + kCell * ((i + 0.5) / kSteps - 0.5);
            if (std::abs(at) >= 1) continue;
            const double begin = -1 + kCell * std::floor((at + 1) / kCell);
            for (int k = 0; k < 16; ++k, ++count) sum += light(begin + kCell * (k + 0.5) / 16);
        }
        return sum / count;
    }

  private:
    double thetaD() const { return -0.5 * thetaIn_; }
    Vec3d ray(shading::Lobe lobe, double side) const {
        const shading::CrossSection section(parameters_.azimuthal.ior, thetaD(),
                                            parameters_.azimuthal.absorption);
        const int p = shading::order(lobe);
        // Towards the side that the ray comes in at, the camera's way round.
        const double leaves =
            p * std::numbers::pi + 2 * std::asin(side) - 2 * p * std::asin(section.sineInside(side));
        return shading::wrappedGauss(phi_ - leaves, parameters_.azimuthal.width) *
               attenuation(section.at(side), p);
    }

    shading::MarschnerParameters parameters_;
    shading::Marschner model_;
    double thetaIn_ = 0, phi_ = 0, irradiance_ = 0;
    std::array<Vec3d, 3> scale_;
};

TEST_F(AcrossTest, LightLiesWhereRaysThroughTheSectionPutIt) {
    constexpr float kPixels = 40;
    for (const float azimuth : {-0.9f, 0.5f, 1.6f, 2.6f, 3.1f}) {
        const Fibre fibre(kPixels, azimuth);
        const LinearImage image = draw(fibre.scene, acrossOptions());
        const Section section(fibre);
        double difference = 0, variation = 0, mean = 0, ours = 0;
        std::vector<std::array<double, 2>> seen;
        for (std::size_t x = 0; x < kRowSize; ++x) {
            const double side = (static_cast<double>(x) + 0.5 - kRowSize / 2.0) / (kPixels / 2.0);
            if (std::abs(side) > 0.95) continue;
            seen.push_back({pixel(image, x).y(), section.seen(side).y()});
            ours += seen.back()[0];
            mean += seen.back()[1];
        }
        const auto count = static_cast<double>(seen.size());
        EXPECT_NEAR(ours / mean, 1, 0.03) << azimuth;
        for (const auto& [a, b] : seen) {
            difference += std::pow(a / ours - b / mean, 2);
            variation += std::pow(b / mean - 1 / count, 2);
        }
        EXPECT_LT(std::sqrt(difference / variation), 0.15) << azimuth;
    }
}

TEST_F(AcrossTest, AWholeHairIsAsBrightFromNearAsFromAfar) {
    const Vec3d far = lightOf(draw(Fibre(1.02f).scene, acrossOptions()), 1.02);
    for (const float pixels : {1.1f, 1.3f, 1.6f, 3.0f, 8.0f, 30.0f}) {
        const Vec3d near = lightOf(draw(Fibre(pixels).scene, acrossOptions()), static_cast<double>(pixels));
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(near[c] / far[c], 1, 0.025) << pixels << " " << c;
    }
}

TEST_F(AcrossTest, ThinHairHasNoPassOfItsOwn) {
    Renderer renderer(*device);
    const auto passes = [&](const RenderScene& scene, const RenderOptions& how) {
        EXPECT_TRUE(renderer.setScene(scene));
        EXPECT_TRUE(renderPicture(*device, renderer, how));
        return renderer.plan().runs(Pass::across);
    };
    EXPECT_FALSE(passes(Fibre(0.9f).scene, acrossOptions()));
    EXPECT_TRUE(passes(Fibre(2).scene, acrossOptions()));
    RenderOptions blurred = acrossOptions();
    blurred.shadowBlur = 2;
    EXPECT_FALSE(passes(Fibre(2).scene, blurred));
    Fibre kajiya(2);
    kajiya.scene.strands[0].material.fibre.model = ShadingModel::kajiya;
    EXPECT_FALSE(passes(kajiya.scene, acrossOptions()));
    Fibre tubes(2);
    tubes.scene.strands[0].material.tubes = true;
    EXPECT_FALSE(passes(tubes.scene, acrossOptions()));
}

TEST_F(AcrossTest, AllWaysToDrawARibbonShowTheSame) {
    const Fibre fibre(12);
    RenderOptions how = acrossOptions();
    how.frames = 64;
    how.ribbons = Ribbons::strip;
    how.transparency = Transparency::stochastic;
    const LinearImage strip = draw(fibre.scene, how);
    double peak = 0;
    for (std::size_t x = 0; x < kRowSize; ++x) peak = std::max(peak, pixel(strip, x).y());
    // Filters differ: that of sorted fragments is narrower.
    const auto compare = [&](const LinearImage& other, const char* what, double tolerance = 0.04) {
        for (std::size_t x = 0; x < kRowSize; ++x)
            EXPECT_NEAR(pixel(other, x).y(), pixel(strip, x).y(), tolerance * peak) << what << " " << x;
        EXPECT_NEAR(lightOf(other, 12).y() / lightOf(strip, 12).y(), 1, 0.02) << what;
    };
    how.ribbons = Ribbons::compute;
    compare(draw(fibre.scene, how), "kernels");
    how.transparency = Transparency::sorted;
    compare(draw(fibre.scene, how), "sorted", 0.12);
    how.ribbons = Ribbons::strip;
    how.transparency = Transparency::weighted;
    compare(draw(fibre.scene, how), "weighted");
    if (!device->info().tessellation) return;
    how.transparency = Transparency::stochastic;
    how.ribbons = Ribbons::tessellated;
    compare(draw(fibre.scene, how), "tessellated");
}

TEST_F(AcrossTest, TheSoftwareRendererShowsTheSame) {
    const auto software = software::makeDevice();
    const Fibre fibre(12);
    RenderOptions how = acrossOptions();
    how.frames = 32;
    how.ribbons = Ribbons::compute;
    how.transparency = Transparency::sorted;
    const LinearImage here = draw(fibre.scene, how);
    const auto there = renderPicture(*software, fibre.scene, how);
    ASSERT_TRUE(there) << there.error().message();
    for (std::size_t x = 0; x < kRowSize; ++x)
        EXPECT_NEAR(pixel(there->linear, x).y(), pixel(here, x).y(), 0.01 * pixel(here, kRowSize / 2 + 2).y())
            << x;
}

}  // namespace
}  // namespace hairloom::render
