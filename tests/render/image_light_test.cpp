// SPDX-License-Identifier: GPL-3.0-or-later
// Light from images and areas: against lamps of the same light, and closed forms of what areas send out.
#include <gmock/gmock.h>

#include "core/render/light_cut.h"
#include "core/shading/melanin.h"
#include "tests/render/render_fixture.h"

namespace hairloom::render {
namespace {

constexpr float kPiFloat = 3.14159265f;

/// An image of longitude and latitude with light of one colour within so many degrees of a direction, on
/// `around`.
LinearImage softBox(const Vec3f& towards, float degreesAcross, const Vec3f& radiance, const Vec3f& around,
                    std::uint32_t height = 180) {
    LinearImage image{2 * height, height, {}};
    for (std::uint32_t y = 0; y < image.height; ++y) {
        const float theta = kPiFloat * (static_cast<float>(y) + 0.5f) / static_cast<float>(image.height);
        for (std::uint32_t x = 0; x < image.width; ++x) {
            const float phi =
                2 * kPiFloat * ((static_cast<float>(x) + 0.5f) / static_cast<float>(image.width) - 0.5f);
            const Vec3f d(std::sin(theta) * std::sin(phi), std::cos(theta), std::sin(theta) * std::cos(phi));
            const bool inside = d.dot(towards.normalized()) > std::cos(radians(0.5f * degreesAcross));
            const Vec3f light = inside ? radiance : around;
            image.rgba.insert(image.rgba.end(), {light.x(), light.y(), light.z(), 1});
        }
    }
    return image;
}

double correlation(const LinearImage& a, const LinearImage& b) {
    double n = 0, sa = 0, sb = 0, saa = 0, sbb = 0, sab = 0;
    for (std::size_t i = 0; i < a.rgba.size(); i += 4) {
        const auto x = static_cast<double>(a.rgba[i + 1]), y = static_cast<double>(b.rgba[i + 1]);
        ++n;
        sa += x;
        sb += y;
        saa += x * x;
        sbb += y * y;
        sab += x * y;
    }
    return (n * sab - sa * sb) / std::sqrt((n * saa - sa * sa) * (n * sbb - sb * sb));
}

class ImageLight : public RenderTest {
  protected:
    LinearImage picture(const RenderScene& scene, RenderOptions options = {}) {
        options.width = options.height = 96;
        options.frames = 8;
        options.shadowResolution = 512;
        const auto drawn = renderPicture(*device, scene, options);
        EXPECT_TRUE(drawn) << drawn.error().message();
        return drawn ? drawn->linear : LinearImage();
    }
};

RenderScene blondScene(const TestHead& head) {
    RenderScene scene = head.scene();
    scene.background = Vec3f::Zero();
    scene.environment = {};
    FibreMaterial& fibre = scene.strands[0].material.fibre;
    fibre.model = ShadingModel::marschner;
    fibre.marschner.azimuthal.absorption = shading::absorption({0.3, 0});
    fibre.marschner.azimuthal.width = 0.2;
    return scene;
}

TEST_F(ImageLight, ASoftBoxIsAsGoodAsALampOfItsLight) {
    const TestHead head(6000);
    RenderScene scene = blondScene(head);
    const Vec3f towards(0.5f, 0.8f, 0.6f);
    const Vec3f colour(1, 0.8f, 0.6f);
    // A cap of 20° across has 2π (1 − cos 10°).
    const float solid = 2 * kPiFloat * (1 - std::cos(radians(10.0f)));
    const auto environment =
        Environment::fromImage(softBox(towards, 20, colour * (kPiFloat / solid), Vec3f::Zero())).value();
    Light lamp;
    lamp.toLight_ws = towards;
    lamp.irradiance = kPiFloat * colour;
    std::array<double, 2> byBox{}, byLamp{};
    for (const Scattering scattering : {Scattering::single, Scattering::dual}) {
        scene.strands[0].material.fibre.scattering = scattering;
        const std::size_t i = scattering == Scattering::dual ? 1 : 0;
        scene.lights = {lamp};
        scene.environment = {};
        const LinearImage lit = picture(scene);
        scene.lights = {};
        scene.environment = environment;
        const LinearImage boxed = picture(scene);
        byLamp[i] = meanLuminance(lit);
        byBox[i] = meanLuminance(boxed);
        EXPECT_GT(correlation(lit, boxed), 0.97) << i;
        EXPECT_NEAR(byBox[i] / byLamp[i], 1, 0.05) << i;
        const Vec3d hue = meanColour(boxed).cwiseQuotient(meanColour(lit));
        EXPECT_NEAR(hue.x() / hue.z(), 1, 0.03) << i;
    }
    EXPECT_NEAR(byBox[1] / byBox[0], byLamp[1] / byLamp[0], 0.04 * byLamp[1] / byLamp[0]);
    EXPECT_GT(byLamp[1] / byLamp[0], 1.5) << "light between hairs shows";
}

TEST_F(ImageLight, WhatLightsHaveNoPlaceJoinsTheLightFromAround) {
    const TestHead head(300);
    RenderScene scene = blondScene(head);
    scene.lights.clear();
    for (int i = 0; i < 40; ++i) {
        Light light;
        const float turn = 2 * kPiFloat * static_cast<float>(i) / 40;
        light.toLight_ws = Vec3f(std::cos(turn), 0.5f, std::sin(turn));
        light.irradiance = Vec3f::Constant(i % 10 == 0 ? 1.0f : 0.1f);
        scene.lights.push_back(light);
    }
    const LightCut cut = cutLights(scene.lights, {}, Vec3f::Zero(), {6, 16});
    EXPECT_LE(cut.lights.size(), 6u);
    float kept = 0;
    for (const Light& light : cut.lights) kept += light.irradiance.x();
    EXPECT_FLOAT_EQ(kept, 4);
    EXPECT_NEAR(cut.rest.coefficients[0].x(), 3.6f * 0.28209479f, 1e-4f);
    EXPECT_GT(meanLuminance(picture(scene)), 0.01);
}

TEST(LightCuts, PartsOfAnImageKeepItsLightAtAnyBudget) {
    // Two boxes of other sizes and colours on a dim sky.
    LinearImage image = softBox(Vec3f(0.2f, 1, 0.1f), 30, Vec3f(9, 9, 9), Vec3f(0.1f, 0.2f, 0.3f));
    const LinearImage other = softBox(Vec3f(-1, 0.1f, -0.4f), 12, Vec3f(60, 40, 20), Vec3f::Zero());
    for (std::size_t i = 0; i < image.rgba.size(); ++i) image.rgba[i] += i % 4 == 3 ? 0 : other.rgba[i];
    const Environment environment = Environment::fromImage(image, 0.5f).value();
    ASSERT_EQ(environment.brightRoots.size(), 1u);
    const Vec3f all = environment.bright[0].irradiance;
    for (const std::uint32_t budget : {1u, 2u, 5u, 16u}) {
        const LightCut cut = cutLights({}, environment, Vec3f::Zero(), {budget, 16});
        EXPECT_EQ(cut.lights.size(), budget);
        EXPECT_TRUE(cut.rest.bright.empty());
        Vec3f sum = Vec3f::Zero();
        for (const Light& light : cut.lights) sum += light.irradiance;
        EXPECT_TRUE(sum.isApprox(all, 1e-4f)) << budget;
        if (budget != 2) continue;
        // With two, each box is one.
        const bool firstIsUp = cut.lights[0].toLight_ws.y() > 0.5f;
        const Light& up = cut.lights[firstIsUp ? 0 : 1];
        const Light& side = cut.lights[firstIsUp ? 1 : 0];
        EXPECT_GT(up.toLight_ws.dot(Vec3f(0.2f, 1, 0.1f).normalized()), 0.999f);
        EXPECT_GT(side.toLight_ws.dot(Vec3f(-1, 0.1f, -0.4f).normalized()), 0.999f);
        const float cap = 2 * kPiFloat * (1 - std::cos(radians(15.0f)));
        EXPECT_NEAR(up.irradiance.x(), 0.5f * 9.1f * cap, 0.02f * 0.5f * 9 * cap);
    }
    // The rest is the sky alone, as far as the boxes are not in its place.
    EXPECT_NEAR(environment.coefficients[0].z(), 0.5f * 0.3f * 3.5449077f, 0.015f);
    EXPECT_TRUE(Environment::fromImage(softBox(Vec3f::UnitY(), 90, Vec3f::Constant(2), Vec3f::Ones()))
                    ->brightRoots.empty())
        << "what harmonics hold stays with them";
}

TEST(LightCuts, EnvironmentsAddUp) {
    Environment sum = Environment::gradient(Vec3f::Ones(), Vec3f::Ones());
    const auto box =
        Environment::fromImage(softBox(Vec3f::UnitX(), 20, Vec3f::Ones(), Vec3f::Zero())).value();
    sum.add(box);
    sum.add(box);
    EXPECT_EQ(sum.brightRoots.size(), 2u);
    EXPECT_FALSE(box.dark());
    const LightCut cut = cutLights({}, sum, Vec3f::Zero(), {2, 16});
    EXPECT_TRUE(cut.lights[0].irradiance.isApprox(cut.lights[1].irradiance));
    EXPECT_NEAR(cut.rest.radiance(Vec3f::UnitZ()).x(), 1, 1e-4f);
}

/// A matte ground under an area 1 m above it, facing down; its brightness under the middle and `aside` metres
/// from there.
class AreaLight : public ImageLight {
  protected:
    double ground(const Light& area, float aside) {
        const TestPlate plate;
        RenderScene scene;
        RenderMesh mesh = plate.mesh();
        mesh.albedo = Vec3f::Ones();
        mesh.matte = true;
        scene.meshes = {mesh};
        scene.environment = {};
        scene.lights = {area};
        scene.camera.eye_ws = Vec3f(aside, 0.5f, 0);
        scene.camera.target_ws = Vec3f(aside, 0, 0);
        scene.camera.up_ws = -Vec3f::UnitZ();
        scene.camera.orthographicHeight = 0.02f;
        RenderOptions options;
        options.shadowLights = 16;
        return meanLuminance(picture(scene, options)) * static_cast<double>(kPi);
    }
    static Light above(LightKind kind, float halfWidth, float halfHeight) {
        Light light;
        light.kind = kind;
        light.position_ws = Vec3f(0, 1, 0);
        light.halfAcross_ws = Vec3f(halfWidth, 0, 0);
        light.halfUp_ws = Vec3f(0, 0, halfHeight);
        light.radiance = Vec3f::Ones();
        light.castsShadow = false;
        return light;
    }
};

TEST_F(AreaLight, SendsOutWhatClosedFormsSay) {
    for (const double r : {0.1, 0.4}) {
        const double expected = static_cast<double>(kPi) * r * r / (r * r + 1);
        const auto half = static_cast<float>(r);
        EXPECT_NEAR(ground(above(LightKind::disc, half, half), 0), expected, 0.03 * expected) << r;
    }
    const double a = 0.4, b = 0.15;
    const auto part = [](double x, double y) {
        return x / std::sqrt(1 + x * x) * std::atan(y / std::sqrt(1 + x * x));
    };
    const double expected = 2 * (part(a, b) + part(b, a));
    EXPECT_NEAR(ground(above(LightKind::rectangle, 0.4f, 0.15f), 0), expected, 0.03 * expected);
    // From afar it is a point of that area: cos^4 of the way's angle.
    const double cosine = 1 / std::sqrt(1 + 0.7 * 0.7);
    const double small = 0.04 * 0.04 * 4;
    EXPECT_NEAR(ground(above(LightKind::rectangle, 0.04f, 0.04f), 0.7f), small * std::pow(cosine, 4),
                0.03 * small);
    // It has a back.
    Light turned = above(LightKind::rectangle, 0.4f, 0.15f);
    turned.halfUp_ws = -turned.halfUp_ws;
    EXPECT_EQ(ground(turned, 0), 0);
}

}  // namespace
}  // namespace hairloom::render
