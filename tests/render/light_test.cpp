// SPDX-License-Identifier: GPL-3.0-or-later
// Views from lights, point lights, and light from around against quadrature.
#include "core/render/light.h"

#include "core/render/environment.h"
#include "tests/render/light_fixture.h"

namespace hairloom::render {
namespace {

Vec3f randomUnit(Random& random) {
    Vec3f v;
    do {
        v = Vec3f(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    } while (v.norm() > 1 || v.norm() < 0.1f);
    return v.normalized();
}

TEST(LightView, HoldsAllHairAndWhatShadesIt) {
    Random random(3);
    for (int round = 0; round < 40; ++round) {
        std::vector<Vec3f> hair;
        Box3f all;
        for (int i = 0; i < 100; ++i) {
            hair.push_back(Vec3f(0.1f, 1.6f, 0) + 0.15f * randomUnit(random));
            all.extend(hair.back());
        }
        all.extend(Vec3f(0, 1.2f, -0.3f));
        Light light;
        light.kind = round % 2 == 0 ? LightKind::directional : LightKind::point;
        light.toLight_ws = randomUnit(random);
        light.position_ws = Vec3f(0.1f, 1.6f, 0) + 0.6f * randomUnit(random);
        const LightView view = fitLight(light, hair, all);
        float reach = 0;
        for (const Vec3f& p : hair) {
            const Vec4f clip = view.clipFromWorld * p.homogeneous();
            ASSERT_GT(clip.w(), 0);
            reach = std::max({reach, std::abs(clip.x() / clip.w()), std::abs(clip.y() / clip.w())});
            const float depth = clip.z() / clip.w();
            ASSERT_GE(depth, 0);
            ASSERT_LE(depth, 1);
            // The shader's metresBehindNear().
            const float farPlane = view.nearPlane + view.depthRange;
            const float metres =
                view.nearPlane > 0
                    ? view.nearPlane * farPlane / (farPlane - depth * view.depthRange) - view.nearPlane
                    : depth * view.depthRange;
            ASSERT_GE(metres, view.hairStart - 1e-3f);
            ASSERT_LE(metres, view.hairStart + view.hairRange + 1e-3f);
        }
        EXPECT_LE(reach, 1.0f);
        EXPECT_GE(reach, 0.75f);  // fitted, not merely around
    }
}

// Section 5.4 prints a near plane 2 d_h (1 − r_h/d) wide without saying what d_h is. With r_h it cuts the
// hair that a light sees from the side.
TEST(LightView, HoldsHairOnTheTangentsOfAPointLight) {
    const float radius = 0.15f, distance = 0.5f;
    Light light;
    light.kind = LightKind::point;
    light.position_ws = Vec3f(0, 1.6f, distance);
    // Where rays of the light touch the sphere around the hair.
    const float depth = radius * radius / distance;
    const float ring = radius * std::sqrt(1 - radius * radius / (distance * distance));
    std::vector<Vec3f> hair;
    Box3f all;
    for (int i = 0; i < 360; ++i) {
        const float angle = static_cast<float>(i) * kPi / 180;
        hair.push_back(Vec3f(ring * std::cos(angle), 1.6f + ring * std::sin(angle), depth));
        all.extend(hair.back());
    }
    const LightView view = fitLight(light, hair, all);
    float reach = 0;
    for (const Vec3f& p : hair) {
        const Vec4f clip = view.clipFromWorld * p.homogeneous();
        reach = std::max({reach, std::abs(clip.x() / clip.w()), std::abs(clip.y() / clip.w())});
    }
    EXPECT_LE(reach, 1.0f);
    const float toNear = distance - radius;
    const float width = 2 * toNear * ring / (distance - depth);
    EXPECT_NEAR(width, 0.220f, 5e-4f);
    EXPECT_NEAR(2 * radius * (1 - radius / distance), 0.210f, 5e-4f) << "as printed";
}

TEST(LightView, RestingHairKeepsItsTexelsWhileOtherHairMoves) {
    Random random(4);
    for (const LightKind kind : {LightKind::directional, LightKind::point}) {
        Light light;
        light.kind = kind;
        light.toLight_ws = Vec3f(0.3f, 0.8f, 0.4f);
        light.position_ws = Vec3f(0.6f, 2.2f, 0.9f);
        std::vector<Vec3f> hair;
        for (int i = 0; i < 100; ++i) hair.push_back(Vec3f(0, 1.6f, 0) + 0.15f * randomUnit(random));
        const Vec3f resting = hair[7];
        LightView before;
        int jumps = 0;
        for (int frame = 0; frame < 60; ++frame) {
            std::vector<Vec3f> moved = hair;
            const float sway = 0.04f * std::sin(0.1f * static_cast<float>(frame));
            for (std::size_t i = 0; i < 50; ++i) moved[2 * i].x() += sway;
            Box3f all;
            for (const Vec3f& p : moved) all.extend(p);
            const LightView view = fitLight(light, moved, all);
            const auto texel = [&](const LightView& v) {
                const Vec4f clip = v.clipFromWorld * resting.homogeneous();
                return Eigen::Vector2f(512 * (clip.head<2>() / clip.w()).array() + 512);
            };
            if (frame > 0) {
                // By none or whole texels, but where the view takes another size.
                const Eigen::Vector2f by = texel(view) - texel(before);
                const Eigen::Vector2f part = by - Eigen::Vector2f(by.array().round());
                jumps += part.norm() > 0.02f ? 1 : 0;
            }
            before = view;
        }
        EXPECT_LE(jumps, 4) << "of 59 frames";
    }
}

TEST(Environment, GradientIsLinearInHeight) {
    const Environment e = Environment::gradient({1, 2, 3}, {0.5f, 0, 1});
    EXPECT_TRUE(e.radiance({0, 1, 0}).isApprox(Vec3f(1, 2, 3), 1e-5f));
    EXPECT_TRUE(e.radiance({0, -1, 0}).isApprox(Vec3f(0.5f, 0, 1), 1e-5f));
    EXPECT_TRUE(e.radiance({1, 0, 0}).isApprox(Vec3f(0.75f, 1, 2), 1e-5f));
    EXPECT_FALSE(e.dark());
    EXPECT_TRUE(Environment().dark());
}

TEST(Environment, ImagesComeBackUpToTheSecondOrder) {
    Random random(4);
    Environment expected;
    for (Vec3f& c : expected.coefficients) c = randomUnit(random);
    LinearImage image{64, 32, std::vector<float>(64 * 32 * 4)};
    for (std::uint32_t y = 0; y < 32; ++y) {
        for (std::uint32_t x = 0; x < 64; ++x) {
            const float theta = kPi * (static_cast<float>(y) + 0.5f) / 32;
            const float phi = 2 * kPi * ((static_cast<float>(x) + 0.5f) / 64 - 0.5f);
            const Vec3f d(std::sin(theta) * std::sin(phi), std::cos(theta), std::sin(theta) * std::cos(phi));
            const Vec3f light = expected.radiance(d);
            std::copy_n(light.data(), 3, &image.rgba[4 * (std::size_t{y} * 64 + x)]);
        }
    }
    const auto read = Environment::fromImage(image, 2);
    ASSERT_TRUE(read);
    for (std::size_t i = 0; i < 9; ++i) {
        EXPECT_LT((read->coefficients[i] - 2 * expected.coefficients[i]).norm(), 0.02f) << i;
    }
    image.rgba[17] = std::nanf("");
    EXPECT_FALSE(Environment::fromImage(image));
    EXPECT_FALSE(Environment::fromImage({}));
}

class LightShaderTest : public LightTest {};

/// Points all around the origin at one distance.
std::vector<shaders::LightCase> pointsAround(double distance, int count) {
    Random random(8);
    std::vector<shaders::LightCase> cases;
    for (int i = 0; i < count; ++i) {
        const Vec3f p = static_cast<float>(distance) * randomUnit(random);
        cases.push_back({toShader(p, 0), toShader(Vec3f::UnitY(), 0)});
    }
    return cases;
}

/// Mean shares of directions that see the sky, x, and the head, y.
Vec2d meanSeen(const std::vector<shaders::LightAnswer>& answers) {
    Vec2d sum = Vec2d::Zero();
    for (const shaders::LightAnswer& answer : answers) sum += Vec2d(answer.sky.x, answer.sky.y);
    return sum / static_cast<double>(answers.size());
}

// From outside a ball hides as much of the sky as its cap of the sphere of directions.
TEST_F(LightShaderTest, TheHeadHidesItsPartOfTheSky) {
    constexpr double kRadius = 0.1;
    RenderScene scene;
    TestHead head(0);
    for (Vec3f& p : head.positions) p = static_cast<float>(kRadius) * p.normalized();
    RenderMesh mesh;
    mesh.positions_ws = head.positions;
    mesh.indices = head.indices;
    scene.meshes = {mesh};
    for (const double distance : {1.1, 1.5, 2.0}) {
        const Vec2d seen = meanSeen(light(scene, {}, pointsAround(distance * kRadius, 400)));
        const double hidden = 0.5 * (1 - std::sqrt(1 - 1 / (distance * distance)));
        EXPECT_NEAR(seen.y(), hidden, 0.03) << distance;
        EXPECT_NEAR(seen.x(), 1 - hidden, 0.03) << distance;
    }
}

// Straight fibres along random chords of a ball, which fill it evenly and in all directions.
TEST_F(LightShaderTest, HairHidesTheSkyAsFarAsItReaches) {
    constexpr double kRadius = 0.1, kFibres = 3;  // along a radius
    constexpr float kThick = 0.0001f;
    // Of cylinders in all directions a ray sees pi/4 of length times diameter.
    const double volume = 4.0 / 3 * static_cast<double>(kPi) * kRadius * kRadius * kRadius;
    const double length =
        kFibres / kRadius * volume / (0.25 * static_cast<double>(kPi) * static_cast<double>(2 * kThick));
    TestStrands strands;
    Random random(6);
    for (int i = 0; i < static_cast<int>(length / (4.0 / 3 * kRadius)); ++i) {
        const Vec3f along = randomUnit(random);
        Vec3f beside = randomUnit(random);
        beside = (beside - beside.dot(along) * along).normalized();
        const double off = kRadius * std::sqrt(random.uniformDouble());
        const Vec3f middle = static_cast<float>(off) * beside;
        const Vec3f half = static_cast<float>(std::sqrt(kRadius * kRadius - off * off)) * along;
        strands.add({middle - half, middle + half}, kThick);
    }
    RenderScene scene;
    scene.environment = Environment::gradient(Vec3f::Ones(), Vec3f::Ones());
    scene.strands = {strands.view()};
    RenderOptions options;
    options.subdivisions = 1;
    const Vec2d within = meanSeen(light(scene, options, pointsAround(0.01 * kRadius, 50)));
    EXPECT_NEAR(within.x(), std::exp(-kFibres), 0.03);
    const Vec2d atTheRim = meanSeen(light(scene, options, pointsAround(kRadius, 200)));
    const double chords = (1 - std::exp(-2 * kFibres)) / (2 * kFibres);
    EXPECT_NEAR(atTheRim.x(), 0.5 + 0.5 * chords, 0.04);
    EXPECT_NEAR(atTheRim.y(), 0, 1e-3);
}

// Mean radiance weighted by the cosine over the hemisphere, and by the sine over the sphere.
TEST_F(LightShaderTest, EnvironmentAgreesWithQuadrature) {
    Random random(5);
    RenderScene scene;
    for (std::size_t i = 0; i < 9; ++i) scene.environment.coefficients[i] = 0.2f * randomUnit(random);
    scene.environment.coefficients[0] = Vec3f(8, 9, 10);  // nothing becomes negative
    std::vector<shaders::LightCase> cases;
    std::vector<Vec3f> directions;
    for (int i = 0; i < 32; ++i) {
        directions.push_back(randomUnit(random));
        cases.push_back({{}, toShader(directions.back(), 0)});
    }
    const auto results = light(scene, {}, cases);
    ASSERT_EQ(results.size(), 32u);
    constexpr int kSteps = 60;
    for (std::size_t i = 0; i < directions.size(); ++i) {
        Vec3d hair = Vec3d::Zero(), skin = Vec3d::Zero();
        double hairWeight = 0, skinWeight = 0;
        for (int a = 0; a < kSteps; ++a) {
            for (int b = 0; b < 2 * kSteps; ++b) {
                const double theta = static_cast<double>(kPi) * (a + 0.5) / kSteps;
                const double phi = static_cast<double>(kPi) * (b + 0.5) / kSteps;
                const Vec3d d(std::sin(theta) * std::cos(phi), std::cos(theta),
                              std::sin(theta) * std::sin(phi));
                const double cosine = d.dot(directions[i].cast<double>());
                const Vec3d radiance = scene.environment.radiance(d.cast<float>()).cast<double>();
                const double onHair = std::sqrt(std::max(0.0, 1 - cosine * cosine)) * std::sin(theta);
                const double onSkin = std::max(cosine, 0.0) * std::sin(theta);
                hair += radiance * onHair;
                skin += radiance * onSkin;
                hairWeight += onHair;
                skinWeight += onSkin;
            }
        }
        const auto& h = results[i].onHair;
        const auto& s = results[i].onSkin;
        EXPECT_LT((Vec3d(h.x, h.y, h.z) - hair / hairWeight).norm(), 0.01);
        EXPECT_LT((Vec3d(s.x, s.y, s.z) - skin / skinWeight).norm(), 0.01);
    }
}

TEST_F(LightShaderTest, APointLightFarAwayIsADirectionalOne) {
    const TestHead head(300);
    RenderScene scene = head.scene();
    scene.lights.resize(1);
    RenderOptions options;
    options.width = options.height = 48;
    options.frames = 4;
    options.shadowResolution = 256;
    const auto directional = renderPicture(*device, scene, options);
    Light point;
    point.kind = LightKind::point;
    point.position_ws = 20 * scene.lights[0].toLight_ws.normalized();
    point.intensity = 400 * scene.lights[0].irradiance;
    scene.lights[0] = point;
    const auto fromPoint = renderPicture(*device, scene, options);
    ASSERT_TRUE(directional);
    ASSERT_TRUE(fromPoint) << fromPoint.error().message();
    EXPECT_NEAR(meanLuminance(fromPoint->linear) / meanLuminance(directional->linear), 1, 0.01);
}

TEST_F(LightShaderTest, PointLightsFallOffWithTheSquare) {
    const TestPlate plate;
    RenderScene scene;
    RenderMesh mesh = plate.mesh();
    mesh.albedo = Vec3f::Constant(0.5f);
    mesh.matte = true;
    scene.meshes = {mesh};
    scene.environment = {};
    scene.camera.eye_ws = {0, 1, 0};
    scene.camera.target_ws = {0, 0, 0};
    scene.camera.up_ws = Vec3f::UnitZ();
    scene.camera.verticalFov = 2;
    Light light;
    light.kind = LightKind::point;
    light.position_ws = {0, 2, 0};
    light.intensity = Vec3f::Constant(3);
    scene.lights = {light};
    RenderOptions options;
    options.width = options.height = 8;
    options.frames = 1;
    const auto picture = renderPicture(*device, scene, options);
    ASSERT_TRUE(picture) << picture.error().message();
    // Lambert: albedo / pi * intensity / distance².
    EXPECT_NEAR(meanLuminance(picture->linear), 0.5 / 3.14159265 * 3 / 4, 0.002);
}

}  // namespace
}  // namespace hairloom::render
