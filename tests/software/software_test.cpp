// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures of the software renderer against those of a graphics API, against closed forms, and on any number
// of threads.

#include "core/software/device.h"

#include <atomic>
#include <chrono>
#include <thread>

#include "core/base/parallel.h"
#include "core/render/flip.h"
#include "core/render/renderer.h"
#include "tests/render/pile.h"
#include "tests/render/render_fixture.h"

namespace hairloom::render {
namespace {

class SoftwareTest : public testing::Test {
  protected:
    static RenderOptions options(std::uint32_t size) {
        RenderOptions result;
        result.width = result.height = size;
        result.samples = 4;
        result.frames = 1;
        result.shadowResolution = 256;
        result.skyStrands = 512;
        result.transparency = Transparency::sorted;
        return result;
    }
    static RenderScene withModel(const TestHead& head, ShadingModel model) {
        RenderScene scene = head.scene();
        scene.strands[0].material.fibre.model = model;
        return scene;
    }
    Picture draw(const RenderScene& scene, const RenderOptions& how) {
        auto picture = renderPicture(*device_, scene, how);
        EXPECT_TRUE(picture) << (picture ? "" : picture.error().message());
        return picture ? std::move(*picture) : Picture();
    }
    void expectFinite(const Picture& picture) {
        for (const float value : picture.linear.rgba) ASSERT_TRUE(std::isfinite(value));
    }

    std::unique_ptr<gpu::Device> device_ = software::makeDevice();
};

/// Share of a picture that is not background, by the coverage of one that is transparent behind.
double coverage(const LinearImage& image) {
    double sum = 0;
    for (std::size_t i = 3; i < image.rgba.size(); i += 4) sum += image.rgba[i];
    return sum / (static_cast<double>(image.rgba.size()) / 4);
}

TEST_F(SoftwareTest, PicturesAreThoseOfAGraphicsApi) {
    auto api = gpu::createDevice(gpu::testDevice());
    ASSERT_TRUE(api) << api.error().message();
    const TestHead head(400);
    RenderOptions how = options(96);
    how.shadowResolution = 128;
    how.skyStrands = 64;
    for (const auto& [model, scattering] : {std::pair{ShadingModel::kajiya, Scattering::dual},
                                            std::pair{ShadingModel::marschner, Scattering::dual},
                                            std::pair{ShadingModel::marschner, Scattering::volume}}) {
        RenderScene scene = withModel(head, model);
        scene.strands[0].material.fibre.scattering = scattering;
        const auto theirs = renderPicture(**api, scene, how);
        ASSERT_TRUE(theirs) << theirs.error().message();
        const Picture ours = draw(scene, how);
        const auto flip = flipDifference(theirs->image, ours.image);
        ASSERT_TRUE(flip);
        EXPECT_LT(flip->mean, 0.01) << static_cast<int>(model);
        EXPECT_GT(decibels(theirs->image, ours.image), 38) << static_cast<int>(model);
        EXPECT_NEAR(meanLuminance(ours.linear) / meanLuminance(theirs->linear), 1, 0.01);
        EXPECT_EQ(ours.strands, theirs->strands);
    }
}

TEST_F(SoftwareTest, LayersOfAPictureAreThoseOfAGraphicsApi) {
    auto api = gpu::createDevice(gpu::testDevice());
    ASSERT_TRUE(api) << api.error().message();
    const TestHead head(200);
    RenderOptions how = options(96);
    how.surface = true;
    const RenderScene scene = head.scene();
    const auto theirs = renderPicture(**api, scene, how);
    ASSERT_TRUE(theirs) << theirs.error().message();
    const Picture ours = draw(scene, how);
    ASSERT_EQ(ours.surface.size(), theirs->surface.size());
    std::size_t same = 0;
    for (std::size_t i = 0; i < ours.surface.size(); ++i) {
        const SurfacePixel& a = ours.surface[i];
        const SurfacePixel& b = theirs->surface[i];
        if (a.strand == b.strand && (a.depth == b.depth || std::abs(a.depth - b.depth) < 1e-4f * b.depth))
            ++same;
    }
    EXPECT_GT(static_cast<double>(same) / static_cast<double>(ours.surface.size()), 0.995);
}

TEST_F(SoftwareTest, ThreadsDoNotShow) {
    const TestHead head(600);
    const RenderScene scene = withModel(head, ShadingModel::marschner);
    RenderOptions how = options(128);
    how.frames = 2;
    std::vector<float> first;
    for (const std::size_t threads : {1u, 2u, 5u}) {
        setThreadCount(threads);
        const Picture picture = draw(scene, how);
        if (first.empty()) first = picture.linear.rgba;
        EXPECT_EQ(picture.linear.rgba, first) << threads << " threads";
    }
    setThreadCount(0);
}

TEST_F(SoftwareTest, TransparentKindsThatAreAskedForAreDrawn) {
    const TestHead head(600);
    const RenderScene scene = head.scene();
    RenderOptions how = options(96);
    const Picture sorted = draw(scene, how);
    how.transparency = Transparency::stochastic;
    how.frames = 32;
    const Picture many = draw(scene, how);
    EXPECT_NEAR(meanLuminance(many.linear) / meanLuminance(sorted.linear), 1, 0.03);
    how.frames = 1;
    how.filter = PostFilter::fxaa;
    expectFinite(draw(scene, how));
    how.filter = PostFilter::none;
    how.shadowBlur = 3;
    expectFinite(draw(scene, how));
}

TEST_F(SoftwareTest, NothingIsTheBackground) {
    RenderScene scene;
    scene.background = Vec3f(0.1f, 0.2f, 0.3f);
    const Picture picture = draw(scene, options(40));
    for (std::size_t i = 0; i < picture.linear.rgba.size(); i += 4) {
        ASSERT_FLOAT_EQ(picture.linear.rgba[i], 0.1f);
        ASSERT_FLOAT_EQ(picture.linear.rgba[i + 2], 0.3f);
    }
}

/// One hair of half a pixel's width across the view covers half of a row of pixels.
TEST_F(SoftwareTest, OneHairCoversWhatItIsWide) {
    constexpr std::uint32_t kSize = 33;
    RenderScene scene;
    scene.camera.eye_ws = {0, 0, 1};
    scene.camera.target_ws = Vec3f::Zero();
    const float pixel = 2 * std::tan(radians(scene.camera.verticalFov) / 2) / kSize;
    for (const float width : {0.1f, 0.5f, 1.0f, 3.0f}) {
        TestStrands strands;
        strands.add({Vec3f(-1, 0, 0), Vec3f(0, 0, 0), Vec3f(1, 0, 0)}, 0.5f * width * pixel);
        scene.strands = {strands.view()};
        RenderOptions how = options(kSize);
        how.transparentBackground = true;
        EXPECT_NEAR(coverage(draw(scene, how).linear), width / kSize, 0.02f * width / kSize) << width;
    }
}

TEST_F(SoftwareTest, MoreHairThanIsKeptIsAsDark) {
    expectDeepHairIsAsDark(
        options(Pile::kSize), 0.03f,
        [this](const RenderScene& scene, const RenderOptions& how) { return draw(scene, how).linear; });
}

TEST_F(SoftwareTest, HairThatCannotBeSeenIsNotDrawn) {
    RenderScene scene;
    scene.camera.eye_ws = {0, 0, 1};
    scene.camera.target_ws = Vec3f::Zero();
    RenderOptions how = options(48);
    how.transparentBackground = true;
    // Behind the eye; through it; beside the picture; no wider than nothing; no longer than nothing; of a
    // kilometre.
    const std::vector<std::pair<TestStrands, bool>> cases = [] {
        std::vector<std::pair<TestStrands, bool>> all(6);
        all[0].first.add({Vec3f(-1, 0, 3), Vec3f(1, 0, 3)}, 0.001f);
        all[1].first.add({Vec3f(0, 0, 2), Vec3f(0, 0, 1), Vec3f(0.01f, 0, 0)}, 0.001f);
        all[1].second = true;
        all[2].first.add({Vec3f(5, 0, 0), Vec3f(6, 0, 0)}, 0.001f);
        all[3].first.add({Vec3f(-1, 0, 0), Vec3f(1, 0, 0)}, 0.0f);
        all[4].first.add({Vec3f(0, 0, 0), Vec3f(0, 0, 0), Vec3f(0, 0, 0)}, 0.001f);
        all[4].second = true;
        all[5].first.add({Vec3f(-1000, 0, 0), Vec3f(1000, 0, 0)}, 0.9f);
        all[5].second = true;
        return all;
    }();
    for (std::size_t i = 0; i < cases.size(); ++i) {
        scene.strands = {cases[i].first.view()};
        scene.lights = studioLights(scene.camera);
        const Picture picture = draw(scene, how);
        expectFinite(picture);
        if (!cases[i].second) {
            EXPECT_EQ(coverage(picture.linear), 0) << i;
        }
    }
}

/// What has not changed is not done again, and the picture is that of a fresh render.
TEST_F(SoftwareTest, ChangesGiveThePictureOfAFreshRender) {
    const TestHead head(300);
    RenderScene scene = withModel(head, ShadingModel::marschner);
    const RenderOptions how = options(80);
    Renderer renderer(*device_);
    ASSERT_TRUE(renderer.setScene(scene));
    ASSERT_TRUE(renderPicture(*device_, renderer, how));
    scene.camera.eye_ws += Vec3f(0.05f, 0, 0);
    ASSERT_TRUE(renderer.setCamera(scene.camera));
    auto moved = renderPicture(*device_, renderer, how);
    ASSERT_TRUE(moved);
    EXPECT_EQ(moved->linear.rgba, draw(scene, how).linear.rgba);
    std::vector<Vec3f> positions(scene.strands[0].positions_ws.begin(), scene.strands[0].positions_ws.end());
    for (Vec3f& p : positions) p.x() += 0.02f;
    ASSERT_TRUE(renderer.setStrandPositions(0, positions));
    const auto combed = renderPicture(*device_, renderer, how);
    ASSERT_TRUE(combed);
    EXPECT_NE(combed->linear.rgba, moved->linear.rgba);
}

TEST_F(SoftwareTest, WhatItCannotDrawIsAnError) {
    const TestHead head(20);
    RenderOptions how = options(32);
    how.ribbons = Ribbons::strip;
    how.transparency = Transparency::stochastic;
    const auto strips = renderPicture(*device_, head.scene(), how);
    ASSERT_FALSE(strips);
    EXPECT_NE(strips.error().message().find("software renderer"), std::string::npos)
        << strips.error().message();
    how = options(32);
    how.ribbons = Ribbons::tessellated;
    EXPECT_FALSE(renderPicture(*device_, head.scene(), how));
    EXPECT_TRUE(software::isSoftware(*device_));
}

/// What a renderer shows on a device after so many frames; `draw` makes each.
class Screen {
  public:
    Screen(gpu::Device& device, const RenderScene& scene, const RenderOptions& how)
        : device_(device), renderer_(device), how_(how) {
        EXPECT_TRUE(renderer_.setScene(scene));
        gpu::TextureDesc desc;
        desc.name = "screen";
        desc.width = how.width;
        desc.height = how.height;
        desc.format = gpu::Format::Rgba8Unorm;
        desc.usage = gpu::Usage::RenderTarget;
        auto made = device.createTexture(desc);
        EXPECT_TRUE(made);
        if (made) target_ = std::move(*made);
    }

    Renderer& renderer() { return renderer_; }
    Status draw() {
        auto list = device_.createCommandList();
        if (!list) return tl::unexpected(list.error());
        if (auto recorded = renderer_.record(**list, how_, target_); !recorded) return recorded;
        auto submitted = device_.submit(std::move(*list));
        if (!submitted) return tl::unexpected(submitted.error());
        return (*submitted)->wait();
    }
    std::vector<std::uint8_t> pixels() {
        std::vector<std::uint8_t> bytes(std::size_t{4} * how_.width * how_.height);
        EXPECT_TRUE(device_.readTexture(target_, std::as_writable_bytes(std::span(bytes))));
        return bytes;
    }

  private:
    gpu::Device& device_;
    Renderer renderer_;
    RenderOptions how_;
    gpu::TexturePtr target_;
};

/// Marks of all kinds in and around the head, some of them behind the eye.
Overlay scatteredMarks(const RenderScene& scene) {
    const Vec3f eye = scene.camera.eye_ws;
    std::uint32_t state = 7;
    const auto next = [&] {
        state = state * 1664525u + 1013904223u;
        return static_cast<float>(state >> 8u) / static_cast<float>(1u << 24u);
    };
    Overlay overlay;
    for (const bool onTop : {false, true}) {
        for (const OverlayShape shape :
             {OverlayShape::points, OverlayShape::lines, OverlayShape::triangles}) {
            OverlayBatch batch{shape, shape == OverlayShape::points ? 7.0f : 2.5f, onTop, {}};
            for (int i = 0; i < 12; ++i) {
                const Vec3f at = Vec3f(next(), next(), next()) * 0.4f - Vec3f::Constant(0.2f);
                const Vec3f place =
                    i % 6 == 5 ? Vec3f(eye + (eye - at) * 0.3f) : Vec3f(at + scene.camera.target_ws);
                batch.vertices.push_back({Vec4f(place.x(), place.y(), place.z(), 1),
                                          Vec4f(next(), next(), next(), 0.3f + 0.7f * next())});
            }
            overlay.batches.push_back(batch);
        }
    }
    return overlay;
}

TEST_F(SoftwareTest, MarksAreThoseOfAGraphicsApi) {
    auto api = gpu::createDevice(gpu::testDevice());
    ASSERT_TRUE(api) << api.error().message();
    const TestHead head(40);
    const RenderScene scene = head.scene();
    const RenderOptions how = options(128);
    std::vector<std::vector<std::uint8_t>> with, without;
    for (gpu::Device* const device : {api->get(), device_.get()}) {
        Screen screen(*device, scene, how);
        ASSERT_TRUE(screen.draw());
        without.push_back(screen.pixels());
        ASSERT_TRUE(screen.renderer().setOverlay(scatteredMarks(scene)));
        const auto drawn = screen.draw();
        ASSERT_TRUE(drawn) << drawn.error().message();
        with.push_back(screen.pixels());
    }
    std::size_t marked = 0, unlike = 0, wrong = 0;
    for (std::size_t i = 0; i < with[0].size(); ++i) {
        if (with[0][i] != without[0][i]) ++marked;
        const bool same = std::abs(with[0][i] - with[1][i]) <= 3;
        // Beside a mark's edge, and where it comes out of the head.
        if (!same && std::abs(without[0][i] - without[1][i]) <= 3) ++unlike;
        if (std::abs(with[0][i] - with[1][i]) > 3 + std::abs(without[0][i] - without[1][i])) ++wrong;
    }
    EXPECT_GT(marked, with[0].size() / 20);
    EXPECT_LT(unlike, marked / 50);
    EXPECT_LT(wrong, marked / 50);
}

TEST_F(SoftwareTest, WhatWasLeftIsDrawnTheNextTime) {
    const TestHead head(800);
    RenderOptions how = options(128);
    how.frames = 3;
    Screen whole(*device_, head.scene(), how);
    for (int i = 0; i < 3; ++i) ASSERT_TRUE(whole.draw());
    auto stop = std::make_shared<std::atomic<bool>>(false);
    const auto device = software::makeDevice(stop);
    Screen screen(*device, head.scene(), how);
    int left = 0;
    for (int microseconds = 300; screen.renderer().accumulated() < 3; microseconds += microseconds / 2) {
        std::thread asks([&] {
            std::this_thread::sleep_for(std::chrono::microseconds(microseconds));
            *stop = true;
        });
        const Status drawn = screen.draw();
        asks.join();
        *stop = false;
        if (drawn) continue;
        EXPECT_NE(drawn.error().message().find(software::kDropped), std::string::npos);
        screen.renderer().takeBack();
        ++left;
    }
    EXPECT_GT(left, 2);
    EXPECT_EQ(screen.pixels(), whole.pixels());
}

TEST_F(SoftwareTest, MapsThatAreHeldAreDrawnOnceTheyAreNot) {
    const TestHead head(600);
    RenderScene scene = head.scene();
    const RenderOptions how = options(96);
    Screen screen(*device_, scene, how);
    screen.renderer().holdMaps(true);
    ASSERT_TRUE(screen.draw()) << "there are none yet";
    const auto first = screen.pixels();
    for (Light& light : scene.lights)
        light.toLight_ws = Eigen::AngleAxisf(1.2f, Vec3f::UnitY()) * light.toLight_ws;
    ASSERT_TRUE(screen.renderer().setLights(scene.lights));
    ASSERT_TRUE(screen.draw());
    const auto held = screen.pixels();
    EXPECT_EQ(held, first) << "light and shadows are those of before";
    screen.renderer().holdMaps(false);
    ASSERT_TRUE(screen.draw());
    Screen fresh(*device_, scene, how);
    ASSERT_TRUE(fresh.draw());
    EXPECT_EQ(screen.pixels(), fresh.pixels());
    EXPECT_NE(held, fresh.pixels());
}

}  // namespace
}  // namespace hairloom::render
