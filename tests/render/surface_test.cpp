// SPDX-License-Identifier: GPL-3.0-or-later
// What pictures tell of the nearest surface in each pixel, against closed forms of cameras and lines.
#include <gmock/gmock.h>

#include <cstring>
#include <set>

#include "tests/render/render_fixture.h"

namespace hairloom::render {
namespace {

constexpr std::uint32_t kSize = 64;

class SurfaceTest : public RenderTest {
  protected:
    static RenderOptions options() {
        RenderOptions options;
        options.width = options.height = kSize;
        options.frames = 1;
        options.shadows = Shadows::none;
        options.surface = true;
        return options;
    }
    std::vector<SurfacePixel> surface(const RenderScene& scene, const RenderOptions& how = options()) {
        const auto picture = renderPicture(*device, scene, how);
        EXPECT_TRUE(picture) << picture.error().message();
        return picture ? picture->surface : std::vector<SurfacePixel>();
    }
    /// Of `scene`, where hair and head were as in `past` a frame ago.
    std::vector<SurfacePixel> moved(const RenderScene& past, const RenderScene& scene) {
        const auto picture = renderPicture(*device, past, scene, options());
        EXPECT_TRUE(picture) << picture.error().message();
        return picture ? picture->surface : std::vector<SurfacePixel>();
    }
};

/// At the origin, 1 m away, looking along -z; 90° from edge to edge, so that a pixel's tangents are plain.
Camera plainCamera() {
    Camera camera;
    camera.eye_ws = Vec3f(0, 0, 1);
    camera.target_ws = Vec3f(0, 0, 0);
    camera.verticalFov = 90;
    return camera;
}

/// Tangents of the way to the middle of a pixel: right and up.
Vec3d tangents(std::size_t pixel) {
    const double x = 2 * (static_cast<double>(pixel % kSize) + 0.5) / kSize - 1;
    const double y = 1 - 2 * (static_cast<double>(pixel / kSize) + 0.5) / kSize;
    return {x, y, -1};
}

TEST_F(SurfaceTest, DepthIsWhereRaysMeetThePlane) {
    TestPlate plate;
    for (Vec3f& corner : plate.corners) corner *= 3;
    RenderScene scene;
    scene.meshes = {plate.mesh()};
    scene.camera = plainCamera();
    scene.camera.eye_ws = Vec3f(0, 1, 2);
    scene.camera.target_ws = Vec3f(0, 1, 1);
    std::size_t seen = 0;
    const auto pixels = surface(scene);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const Vec3d ray = tangents(i);
        const double depth = -1 / ray.y();  // metres along the view down to the ground
        const Vec3d hit = Vec3d(0, 1, 2) + depth * ray;
        const double fromEdge = 3 - std::max(std::abs(hit.x()), std::abs(hit.z()));
        const bool meets = ray.y() < 0 && fromEdge > 0;
        if (ray.y() < 0 && std::abs(fromEdge) < 1e-3) continue;
        ASSERT_EQ(std::isfinite(pixels[i].depth), meets) << i;
        EXPECT_FALSE(pixels[i].hasStrand());
        if (!meets) continue;
        ++seen;
        ASSERT_NEAR(pixels[i].depth, depth, 1e-4 * depth) << i;
        EXPECT_FLOAT_EQ(pixels[i].albedo[0], 0.5f);
    }
    EXPECT_GT(seen, 1000u);
    scene.camera.orthographicHeight = 2;
    const auto flat = surface(scene);
    for (std::size_t i = 0; i < flat.size(); ++i)
        EXPECT_FALSE(std::isfinite(flat[i].depth)) << "a plane seen from its edge";
    scene.camera.eye_ws = Vec3f(0, 2, 0);
    scene.camera.target_ws = Vec3f(0, 0, 0);
    scene.camera.up_ws = Vec3f(0, 0, -1);
    for (const SurfacePixel& pixel : surface(scene)) ASSERT_NEAR(pixel.depth, 2, 1e-4);
}

TEST_F(SurfaceTest, DepthOfAHairThatComesNearerIsThatOfItsLine) {
    // z = 2 x: half of it is three times as far as the other.
    TestStrands strands;
    strands.add({Vec3f(-0.4f, 0, -0.8f), Vec3f(0, 0, 0), Vec3f(0.2f, 0, 0.4f)}, 0.02f);
    RenderScene scene;
    scene.strands = {strands.view()};
    scene.camera = plainCamera();
    RenderOptions how = options();
    how.subdivisions = 1;
    std::size_t seen = 0;
    const auto pixels = surface(scene, how);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        if (!pixels[i].hasStrand()) continue;
        ++seen;
        const double x = tangents(i).x();  // of x = x s and z = 1 - s
        ASSERT_NEAR(pixels[i].depth, 1 / (1 + 2 * x), 2e-3) << i;
    }
    EXPECT_GT(seen, 30u);
}

TEST_F(SurfaceTest, NearerHairIsTold) {
    TestStrands strands;
    strands.add({Vec3f(-1, 0, 0), Vec3f(1, 0, 0)}, 0.1f);
    strands.add({Vec3f(0, -1, 0.2f), Vec3f(0, 1, 0.2f)}, 0.1f);
    strands.add({Vec3f(-1, 0, -0.2f), Vec3f(1, 0, -0.2f)}, 0.2f);
    RenderScene scene;
    scene.strands = {strands.view()};
    scene.camera = plainCamera();
    const auto pixels = surface(scene);
    EXPECT_EQ(pixels[kSize * kSize / 2 + kSize / 2].strand, 1u);
    EXPECT_EQ(pixels[kSize * kSize / 2 + 4].strand, 0u);
    // Below the first, where only the last and widest is.
    EXPECT_EQ(pixels[(kSize / 2 + 4) * kSize + 10].strand, 2u);
}

TEST_F(SurfaceTest, VelocityOfATranslatedGroomIsThatOfItsProjection) {
    TestHead head(120);
    RenderScene scene = head.scene();
    scene.camera.orthographicHeight = 0.4f;
    const double pixel = 0.4 / kSize;
    TestHead before = head;
    const Vec3f right = (scene.camera.target_ws - scene.camera.eye_ws).cross(Vec3f::UnitY()).normalized();
    for (auto* points : {&before.positions, &before.strands.positions}) {
        for (Vec3f& p : *points) p -= 0.0125f * right - Vec3f(0, 0.02f, 0);
    }
    const Vec3f up =
        right.cross(scene.camera.target_ws - scene.camera.eye_ws).normalized();  // of the picture
    std::size_t hairs = 0, head_px = 0;
    RenderScene past = before.scene();
    past.camera = scene.camera;
    for (const SurfacePixel& found : moved(past, scene)) {
        if (!std::isfinite(found.depth)) continue;
        ++(found.hasStrand() ? hairs : head_px);
        ASSERT_NEAR(found.velocityX, 0.0125 / pixel, 1e-3);
        ASSERT_NEAR(found.velocityY, 0.02 * static_cast<double>(up.y()) / pixel, 1e-3);
    }
    EXPECT_GT(hairs, 200u);
    EXPECT_GT(head_px, 50u);
}

TEST_F(SurfaceTest, VelocityIsThatOfPlaceAndCameraTogether) {
    TestStrands strands;
    strands.add({Vec3f(-0.8f, -0.6f, 0.2f), Vec3f(0, 0, -0.2f), Vec3f(0.9f, 0.7f, -0.9f)}, 0.05f);
    RenderScene scene;
    scene.strands = {strands.view()};
    scene.camera = plainCamera();
    // Away from the eye by 10 cm, which the eye follows by 4: as if it had been 6 cm nearer.
    TestStrands before = strands;
    for (Vec3f& p : before.positions) p.z() += 0.1f;
    RenderScene past = scene;
    past.strands = {before.view()};
    past.camera.eye_ws.z() += 0.04f;
    past.camera.target_ws.z() += 0.04f;
    std::size_t seen = 0;
    const auto pixels = moved(past, scene);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        if (!pixels[i].hasStrand()) continue;
        ++seen;
        // Along the line from the middle of the picture, where x / depth goes with one by the depth.
        const auto depth = static_cast<double>(pixels[i].depth);
        const Vec3d way = 0.5 * kSize * tangents(i) * (1 - depth / (depth - 0.06));
        const double reach = 0.5 * kSize * 0.05 / depth * std::abs(1 - depth / (depth - 0.06)) + 0.05;
        ASSERT_NEAR(pixels[i].velocityX, way.x(), reach) << i;
        ASSERT_NEAR(pixels[i].velocityY, -way.y(), reach) << i;
    }
    EXPECT_GT(seen, 100u);
    for (const SurfacePixel& still : surface(scene)) {
        EXPECT_EQ(still.velocityX, 0);
        EXPECT_EQ(still.velocityY, 0);
    }
}

TEST_F(SurfaceTest, NumbersAreThoseOfAllStrandsThatAreThere) {
    constexpr std::uint32_t kHairs = 30;
    TestStrands first, second, behind;
    behind.add({Vec3f(0, 0, -1), Vec3f(0, 0.1f, -1)}, 0.05f);
    for (std::uint32_t i = 0; i < kHairs; ++i) {
        const float x = -0.95f + 1.9f * static_cast<float>(i) / (kHairs - 1);
        first.add({Vec3f(x, 0.1f, 0), Vec3f(x, 0.9f, 0)}, 0.001f);
        if (i == 4) first.add({Vec3f(x, 0.1f, 0)}, 0.001f);  // too short to be drawn
        second.add({Vec3f(x, -0.9f, 0), Vec3f(x, -0.1f, 0)}, 0.001f);
    }
    RenderScene scene;
    scene.strands = {first.view(), second.view(), behind.view()};
    scene.camera = plainCamera();
    RenderOptions how = options();
    std::set<std::uint32_t> seen, wanted;
    for (const SurfacePixel& pixel : surface(scene, how))
        if (pixel.hasStrand()) seen.insert(pixel.strand);
    for (std::uint32_t i = 0; i < 2 * kHairs + 2; ++i)
        if (i != 5) wanted.insert(i);
    EXPECT_EQ(seen, wanted);
}

TEST_F(SurfaceTest, AlbedoIsTheColourThatHairHas) {
    TestStrands strands;
    strands.add({Vec3f(0, -1, 0), Vec3f(0, 1, 0)}, 0.3f);
    RenderScene scene;
    scene.strands = {strands.view()};
    scene.camera = plainCamera();
    StrandShading& material = scene.strands[0].material;
    material.variation = 0;
    material.rootBrightness = 0.5f;
    material.tipBrightness = 1;
    material.albedo = Vec3f(0.8f, 0.4f, 0.2f);
    const auto middle = [&] { return surface(scene)[kSize * kSize / 2 + kSize / 2]; };
    EXPECT_NEAR(middle().albedo[0], 0.6f, 0.01f);
    EXPECT_NEAR(middle().albedo[2], 0.15f, 0.0025f);
    const std::vector<Vec3f> own{Vec3f(0.1f, 0.9f, 0.3f)};
    scene.strands[0].colours = own;
    EXPECT_NEAR(middle().albedo[1], 0.675f, 0.01f);
    scene.strands[0].colours = {};
    // Absorption that makes a colour by Chiang et al. 2016, of a fibre whose scale is 0.2.
    shading::StrandLook look;
    look.quantity = shading::LookQuantity::absorption;
    look.ownScale = 0.2;
    for (int c = 0; c < 3; ++c) {
        look.root[c] = std::pow(0.2 * std::log(0.3 + 0.2 * c), 2);
        look.tip[c] = look.root[c];
    }
    material.look = look;
    material.fibre.model = ShadingModel::marschner;
    for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(middle().albedo[c], 0.3 + 0.2 * static_cast<double>(c), 1e-4);
    material.look.reset();
    material.fibreColour = Vec3f(0.4f, 0.3f, 0.2f);
    EXPECT_NEAR(middle().albedo[0], 0.3f, 0.01f);
}

TEST_F(SurfaceTest, TellingChangesNoLightAndIsRepeatable) {
    const TestHead head(200);
    RenderOptions how = options();
    how.shadows = Shadows::deepOpacity;
    const auto once = renderPicture(*device, head.scene(), how).value();
    const auto again = renderPicture(*device, head.scene(), how).value();
    how.surface = false;
    const auto plain = renderPicture(*device, head.scene(), how).value();
    EXPECT_EQ(once.linear.rgba, plain.linear.rgba);
    EXPECT_TRUE(plain.surface.empty());
    ASSERT_EQ(once.surface.size(), again.surface.size());
    EXPECT_EQ(
        std::memcmp(once.surface.data(), again.surface.data(), once.surface.size() * sizeof(SurfacePixel)),
        0);
}

}  // namespace
}  // namespace hairloom::render
