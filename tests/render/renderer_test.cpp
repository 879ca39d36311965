// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/render/renderer.h"

#include <gmock/gmock.h>

#include "core/gpu/validation.h"
#include "core/render/tone_map.h"
#include "tests/render/render_fixture.h"

namespace hairloom::render {
namespace {

RenderOptions smallOptions() {
    RenderOptions options;
    options.width = options.height = 48;
    options.frames = 2;
    options.shadowResolution = 128;
    return options;
}

class RendererTest : public RenderTest {
  protected:
    gpu::TexturePtr target(const RenderOptions& options, gpu::Format format = gpu::Format::Rgba8Unorm) {
        gpu::TextureDesc desc;
        desc.name = "test target";
        desc.width = options.width;
        desc.height = options.height;
        desc.format = format;
        desc.usage = gpu::Usage::RenderTarget;
        return device->createTexture(desc).value();
    }
    gpu::SubmissionPtr record(Renderer& renderer, const RenderOptions& options,
                              const gpu::TexturePtr& picture) {
        auto list = device->createCommandList().value();
        const auto status = renderer.record(*list, options, picture);
        EXPECT_TRUE(status) << (status ? "" : status.error().message());
        auto submission = device->submit(std::move(list));
        EXPECT_TRUE(submission) << (submission ? "" : submission.error().message());
        return submission ? *submission : nullptr;
    }
    /// As many frames as the options average.
    std::vector<std::uint8_t> pixels(Renderer& renderer, const RenderOptions& options) {
        const auto picture = target(options);
        for (std::uint32_t i = 0; i < options.frames; ++i) record(renderer, options, picture);
        std::vector<std::uint8_t> result(std::size_t{4} * options.width * options.height);
        EXPECT_TRUE(device->readTexture(picture, std::as_writable_bytes(std::span(result))));
        return result;
    }
    std::vector<std::uint8_t> fresh(const RenderScene& scene, const RenderOptions& options) {
        const auto picture = renderPicture(*device, scene, options);
        EXPECT_TRUE(picture) << picture.error().message();
        return picture ? picture->image.rgba : std::vector<std::uint8_t>();
    }
    static std::vector<std::string> passes(const gpu::SubmissionPtr& submission) {
        std::vector<std::string> names;
        const auto times = submission->passTimes().value();
        for (const gpu::PassTime& pass : times) names.push_back(pass.name);
        return names;
    }
};

TEST_F(RendererTest, SequenceOfChangesEqualsFreshPictures) {
    TestHead head(150);
    RenderScene scene = head.scene();
    scene.strands[0].radii = {};
    RenderOptions options = smallOptions();
    Renderer renderer(*device);
    ASSERT_TRUE(renderer.setScene(scene));
    std::vector<std::vector<std::uint8_t>> seen;
    const auto compare = [&](const char* change) {
        seen.push_back(pixels(renderer, options));
        EXPECT_TRUE(seen.back() == fresh(scene, options)) << change;
        if (seen.size() > 1) {
            ASSERT_NE(seen.back(), seen[seen.size() - 2]) << change << " shows nothing";
        }
    };
    compare("scene");
    for (Vec3f& p : head.strands.positions) p.x() += 0.02f * std::abs(p.y());
    ASSERT_TRUE(renderer.setStrandPositions(0, head.strands.positions));
    compare("strand positions");
    for (Vec3f& p : head.positions) p *= 0.97f;
    ASSERT_TRUE(renderer.setMeshPositions(0, head.positions));
    compare("mesh positions");
    const std::vector<Vec3f> colours(head.positions.size(), Vec3f(0.1f, 0.4f, 0.2f));
    scene.meshes[0].vertexAlbedo = colours;
    ASSERT_TRUE(renderer.setMeshAlbedo(0, colours));
    EXPECT_FALSE(renderer.setMeshAlbedo(0, std::span(colours).first(3)));
    EXPECT_FALSE(renderer.setMeshAlbedo(1, colours));
    compare("mesh colours");
    scene.camera.eye_ws.x() *= 0.8f;
    ASSERT_TRUE(renderer.setCamera(scene.camera));
    compare("camera");
    scene.lights.pop_back();
    scene.lights[0].toLight_ws.z() += 0.4f;
    ASSERT_TRUE(renderer.setLights(scene.lights));
    compare("lights");
    scene.strands[0].material.albedo = {0.5f, 0.1f, 0.1f};
    ASSERT_TRUE(renderer.setMaterial(0, scene.strands[0].material));
    compare("colour of the material");
    scene.strands[0].material.radius *= 3;
    ASSERT_TRUE(renderer.setMaterial(0, scene.strands[0].material));
    compare("radius of the material");
    scene.environment = Environment::gradient({0, 0, 1}, {0, 1, 0});
    renderer.setEnvironment(scene.environment);
    compare("environment");
    scene.background = {0.3f, 0.0f, 0.0f};
    renderer.setBackground(scene.background);
    compare("background");
    options.subdivisions = 4;
    compare("subdivisions");
    options.subdivisions = 1;
    compare("fewer subdivisions");
    options.skyStrands = 64;
    compare("fewer strands in maps of the sky");
    options.shadowResolution = 64;
    compare("shadow resolution");
    options.shadows = Shadows::none;
    compare("no shadows");
    // How hair fills space is measured when a scene is set.
    ASSERT_TRUE(renderer.setScene(scene));
    options.shadows = Shadows::absorption;
    compare("absorption");
    scene.strands[0].material.radius *= 0.5f;
    ASSERT_TRUE(renderer.setMaterial(0, scene.strands[0].material));
    compare("absorption by finer hair");
    options.shadows = Shadows::opacityMaps;
    compare("opacity maps");
    options.shadowBlur = 3;
    compare("blurred shadows");
    options.shadowBlur = 1.5f;
    compare("less blurred shadows");
    scene.strands[0].material.albedo = {0.3f, 0.3f, 0.1f};
    ASSERT_TRUE(renderer.setMaterial(0, scene.strands[0].material));
    compare("another colour with blurred shadows");
    options.shadowBlur = 0;
    options.headAbsorption = 100;
    compare("light through the head");
    options.headAbsorption = 0;
    options.transparency = Transparency::weighted;
    compare("blended hair");
    options.ribbons = device->info().tessellation ? Ribbons::tessellated : Ribbons::strip;
    options.detail = 0.5f;
    compare("tessellated ribbons, fewer hairs");
    options.filter = PostFilter::fxaa;
    compare("filter");
    options.samples = 1;
    compare("samples");
    options.frames = 3;
    compare("frames");
    options.exposure = 1;
    compare("exposure");
    options.transparentBackground = true;
    compare("transparent background");
    options.width = 32;
    compare("size");
}

TEST_F(RendererTest, PaintedDyeIsThatOfThePointsItLiesOn) {
    // Four strands side by side, of one segment to be dyed in each.
    TestStrands strands;
    for (int i = 0; i < 4; ++i) {
        const float x = -0.03f + 0.02f * static_cast<float>(i);
        strands.add({{x, 0.04f, 0}, {x, 0.02f, 0}, {x, 0, 0}, {x, -0.02f, 0}, {x, -0.04f, 0}}, 0.004f);
    }
    RenderScene scene;
    scene.strands.push_back(strands.view());
    scene.camera.eye_ws = {0, 0, 0.4f};
    scene.camera.target_ws = Vec3f::Zero();
    scene.background = Vec3f::Zero();
    shading::StrandLook look;
    look.quantity = shading::LookQuantity::colour;
    look.root = look.tip = {0.05, 0.8, 0.05};
    look.dye = {0.6, 0.02, 0.02};
    look.dyeAlong = shading::LinearStep::between(0, 0);
    scene.strands[0].material.look = look;
    const std::vector<float> shares(4, 1.0f);
    std::vector<float> painted(20, 0.0f);
    for (std::size_t s = 0; s < 4; ++s) painted[5 * s + s] = painted[5 * s + s + 1] = 1;
    scene.strands[0].dyes = shares;
    scene.strands[0].pointDyes = painted;
    RenderOptions options = smallOptions();
    options.width = options.height = 96;
    options.shadows = Shadows::none;
    Renderer renderer(*device);
    ASSERT_TRUE(renderer.setScene(scene));
    // In the middle between two points of a strand.
    const auto isRed = [&](const std::vector<std::uint8_t>& picture, std::size_t strand,
                           std::size_t segment) {
        const Mat4f clip = projectionMatrix(scene.camera.verticalFov, 1, 0.1f, 1) * viewMatrix(scene.camera);
        const Vec3f middle =
            0.5f * (strands.positions[5 * strand + segment] + strands.positions[5 * strand + segment + 1]);
        const Vec4f at = clip * middle.homogeneous();
        const auto x = static_cast<std::size_t>((0.5f + 0.5f * at.x() / at.w()) * 96);
        const auto y = static_cast<std::size_t>((0.5f - 0.5f * at.y() / at.w()) * 96);
        const std::size_t pixel = 4 * (96 * y + x);
        return picture[pixel] > picture[pixel + 1] + 20;
    };
    const auto first = pixels(renderer, options);
    for (std::size_t s = 0; s < 4; ++s) {
        for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(isRed(first, s, k), s == k) << s << ' ' << k;
    }
    EXPECT_TRUE(first == fresh(scene, options));
    std::ranges::fill(painted, 0.0f);
    for (std::size_t s = 0; s < 4; ++s) painted[5 * s + 3 - s] = painted[5 * s + 4 - s] = 1;
    ASSERT_TRUE(renderer.setPointDyes(0, painted));
    const auto second = pixels(renderer, options);
    for (std::size_t s = 0; s < 4; ++s) {
        for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(isRed(second, s, k), s + k == 3) << s << ' ' << k;
    }
    painted.assign(20, 0.5f);
    ASSERT_TRUE(renderer.setPointDyes(0, painted));
    EXPECT_TRUE(pixels(renderer, options) == fresh(scene, options));
    EXPECT_FALSE(renderer.setPointDyes(0, std::span(painted).first(3)));
    EXPECT_FALSE(renderer.setPointDyes(1, painted));
}

TEST_F(RendererTest, TablesBakedBehindLetOldOnesServeAndEndInTheSamePicture) {
    TestHead head(80);
    RenderScene scene = head.scene();
    FibreMaterial& fibre = scene.strands[0].material.fibre;
    fibre.model = ShadingModel::marschner;
    fibre.marschner.azimuthal.absorption = {0.2, 0.3, 0.5};
    RenderOptions options = smallOptions();
    options.bakeBehind = true;
    Renderer renderer(*device);
    ASSERT_TRUE(renderer.setScene(scene));
    const auto before = pixels(renderer, options);
    EXPECT_TRUE(renderer.isSettled()) << "there were no others to serve";
    EXPECT_TRUE(before == fresh(scene, options));
    // A control moves, and moves on.
    const auto picture = target(options);
    for (const double red : {0.5, 1.0, 2.0}) {
        fibre.marschner.azimuthal.absorption.x() = red;
        ASSERT_TRUE(renderer.setMaterial(0, scene.strands[0].material));
        record(renderer, options, picture);
        EXPECT_FALSE(renderer.isSettled());
    }
    while (!renderer.isSettled()) record(renderer, options, picture);
    const auto after = pixels(renderer, options);
    EXPECT_NE(after, before);
    EXPECT_TRUE(after == fresh(scene, options));
    // Another model has nothing to show before its tables are there.
    fibre.scattering = Scattering::single;
    ASSERT_TRUE(renderer.setMaterial(0, scene.strands[0].material));
    record(renderer, options, picture);
    EXPECT_TRUE(renderer.isSettled());
}

TEST_F(RendererTest, UnchangedWorkIsNotRepeated) {
    TestHead head(60);
    RenderOptions options = smallOptions();
    options.ribbons = Ribbons::strip;  // on a GPU, too
    Renderer renderer(*device);
    ASSERT_TRUE(renderer.setScene(head.scene()));
    const auto picture = target(options);
    using testing::ElementsAre;
    EXPECT_THAT(
        passes(record(renderer, options, picture)),
        ElementsAre("curves", "head depth", "first hair", "opacity layers", "sky head depth",
                    "sky first hair", "sky layers", "sky seen", "shade", "draw", "accumulate", "tone map"));
    EXPECT_THAT(passes(record(renderer, options, picture)), ElementsAre("draw", "accumulate", "tone map"));
    EXPECT_EQ(renderer.accumulated(), 2u);
    EXPECT_THAT(passes(record(renderer, options, picture)), ElementsAre("tone map"));
    // Lights do not change what is seen of the sky.
    ASSERT_TRUE(renderer.setLights(std::vector<Light>(1)));
    options.shadowResolution *= 2;
    EXPECT_THAT(
        passes(record(renderer, options, picture)),
        ElementsAre("head depth", "first hair", "opacity layers", "shade", "draw", "accumulate", "tone map"));
    Camera camera = head.scene().camera;
    camera.eye_ws.y() += 0.1f;
    ASSERT_TRUE(renderer.setCamera(camera));
    EXPECT_EQ(renderer.accumulated(), 0u);
    EXPECT_THAT(passes(record(renderer, options, picture)),
                ElementsAre("shade", "draw", "accumulate", "tone map"));
}

TEST_F(RendererTest, NothingIsCreatedInSteadyState) {
    TestHead head(60);
    RenderOptions options = smallOptions();
    gpu::ValidationDevice* const watch = gpu::validationOf(*device);
    ASSERT_NE(watch, nullptr);
    Renderer renderer(*device);
    const RenderScene scene = head.scene();
    ASSERT_TRUE(renderer.setScene(scene));
    const auto picture = target(options);
    Overlay overlay;
    overlay.batches.push_back({OverlayShape::points, 4, false, {{}, {}}});
    for (int frame = 0; frame < 6; ++frame) {
        for (Vec3f& p : head.strands.positions) p.x() += 0.001f;
        ASSERT_TRUE(renderer.setStrandPositions(0, head.strands.positions));
        ASSERT_TRUE(renderer.setMeshPositions(0, head.positions));
        ASSERT_TRUE(renderer.setCamera(scene.camera));
        ASSERT_TRUE(renderer.setOverlay(overlay));
        options.exposure += 0.1f;
        record(renderer, options, picture);
        watch->failCreation(0);
    }
    EXPECT_FALSE(device->createSampler({}));  // the fault is still waiting
}

TEST_F(RendererTest, PositionsOnTheDeviceGiveTheSamePicture) {
    TestHead head(150);
    const RenderScene scene = head.scene();
    const RenderOptions options = smallOptions();
    const std::size_t strands = head.strands.offsets.size() - 1;
    const std::size_t points = head.strands.offsets[1];
    for (const std::uint32_t floats : {3u, 4u}) {
        std::vector<float> content(points * strands * floats, -7.0f);
        for (std::size_t s = 0; s < strands; ++s) {
            for (std::size_t p = 0; p < points; ++p) {
                for (int c = 0; c < 3; ++c) {
                    content[(s * points + p) * floats + static_cast<std::size_t>(c)] =
                        head.strands.positions[s * points + p][c];
                }
            }
        }
        gpu::BufferDesc desc;
        desc.name = "simulated";
        desc.size = content.size() * sizeof(float);
        desc.elementBytes = 4;
        const auto buffer = device->createBuffer(desc, std::as_bytes(std::span(content))).value();
        Renderer renderer(*device);
        RenderScene elsewhere = scene;
        // As long and as thick there, which is measured where hair is set.
        std::vector<Vec3f> mirrored = head.strands.positions;
        for (Vec3f& p : mirrored) p.x() = -p.x();
        elsewhere.strands[0].positions_ws = mirrored;
        ASSERT_TRUE(renderer.setScene(elsewhere));
        Box3f bounds;
        for (const Vec3f& p : head.strands.positions) bounds.extend(p);
        ASSERT_TRUE(renderer.setStrandPositions(0, buffer, floats, bounds));
        RenderOptions plain = options;
        plain.shadows = Shadows::none;
        EXPECT_EQ(pixels(renderer, plain), fresh(scene, plain));
        // Lights are fitted to the bounds instead of the points, so that shadows differ a little.
        const auto here = pixels(renderer, options);
        const auto there = fresh(scene, options);
        double sum = 0;
        for (std::size_t i = 0; i < here.size(); ++i) sum += std::abs(here[i] - there[i]);
        EXPECT_LT(sum / static_cast<double>(here.size()), 1.0);
        // And with the points that they are fitted to not at all.
        ASSERT_TRUE(renderer.setStrandPositions(0, buffer, floats, bounds, head.strands.positions));
        EXPECT_EQ(pixels(renderer, options), fresh(scene, options));
        EXPECT_FALSE(renderer.setStrandPositions(0, buffer, 5, bounds));
        EXPECT_FALSE(renderer.setStrandPositions(0, buffer, floats, Box3f()));
        EXPECT_FALSE(renderer.setStrandPositions(1, buffer, floats, bounds));
    }
}

TEST_F(RendererTest, ShowsTheSameInEachFormat) {
    const TestHead head(60);
    const RenderOptions options = smallOptions();
    const auto expected = fresh(head.scene(), options);
    const auto draw = [&](gpu::Format format) {
        Renderer renderer(*device);
        EXPECT_TRUE(renderer.setScene(head.scene()));
        const auto picture = target(options, format);
        for (std::uint32_t i = 0; i < options.frames; ++i) record(renderer, options, picture);
        std::vector<std::byte> bytes(expected.size() / 4 * gpu::bytesPerTexel(format));
        EXPECT_TRUE(device->readTexture(picture, bytes));
        return bytes;
    };
    const auto near = [&](std::size_t i, double value) { EXPECT_NEAR(value, expected[i], 1.01) << i; };
    const auto swapped = draw(gpu::Format::Bgra8Unorm);
    const auto encoded = draw(gpu::Format::Rgba8UnormSrgb);
    const auto wide = draw(gpu::Format::Rgba32Float);
    for (std::size_t i = 0; i < expected.size(); ++i) {
        const std::size_t order[] = {2, 1, 0, 3};
        near(i, std::to_integer<int>(swapped[i - i % 4 + order[i % 4]]));
        near(i, std::to_integer<int>(encoded[i]));
        float value = 0;
        std::memcpy(&value, &wide[4 * i], 4);
        near(i, 255.0 * static_cast<double>(value));
    }
}

TEST_F(RendererTest, ToneCurveAgreesWithTheReference) {
    const TestHead head(200);
    const auto picture = renderPicture(*device, head.scene(), smallOptions());
    ASSERT_TRUE(picture);
    const Image expected = toneMap(picture->linear, smallOptions().exposure);
    for (std::size_t i = 0; i < expected.rgba.size(); ++i) {
        ASSERT_NEAR(picture->image.rgba[i], expected.rgba[i], 1) << i;
    }
}

TEST_F(RendererTest, WrongReplacementsAreErrorsAndChangeNothing) {
    TestHead head(20);
    const RenderScene scene = head.scene();
    Renderer renderer(*device);
    ASSERT_TRUE(renderer.setScene(scene));
    const auto before = pixels(renderer, smallOptions());
    std::vector<Vec3f> positions = head.strands.positions;
    positions[5].z() = std::nanf("");
    const auto status = renderer.setStrandPositions(0, positions);
    ASSERT_FALSE(status);
    EXPECT_THAT(status.error().message(), testing::HasSubstr("strand point 5"));
    positions.pop_back();
    EXPECT_FALSE(renderer.setStrandPositions(0, positions));
    EXPECT_FALSE(renderer.setStrandPositions(3, head.strands.positions));
    EXPECT_FALSE(renderer.setMeshPositions(0, std::vector<Vec3f>(3, Vec3f::Zero())));
    EXPECT_FALSE(renderer.setMaterial(1, {}));
    Light flat;
    flat.kind = LightKind::rectangle;
    flat.halfUp_ws = flat.halfAcross_ws;
    EXPECT_FALSE(renderer.setLights(std::vector{flat}));
    Camera camera;
    camera.target_ws = camera.eye_ws;
    EXPECT_FALSE(renderer.setCamera(camera));
    EXPECT_EQ(pixels(renderer, smallOptions()), before);

    auto list = device->createCommandList().value();
    RenderOptions other = smallOptions();
    other.width += 1;
    EXPECT_FALSE(renderer.record(*list, other, target(smallOptions())));
}

}  // namespace
}  // namespace hairloom::render
