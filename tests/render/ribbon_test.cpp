// SPDX-License-Identifier: GPL-3.0-or-later
// The two kinds of ribbons, hairs thinner than a pixel, and hair far away.
#include <numeric>

#include "core/render/renderer.h"
#include "tests/render/render_fixture.h"

namespace hairloom::render {
namespace {

RenderOptions options(std::uint32_t size, std::uint32_t frames) {
    RenderOptions result;
    result.width = result.height = size;
    result.frames = frames;
    result.shadowResolution = 64;
    result.transparentBackground = true;
    return result;
}

class RibbonTest : public RenderTest {
  protected:
    LinearImage draw(const RenderScene& scene, const RenderOptions& how) {
        const auto picture = renderPicture(*device, scene, how);
        EXPECT_TRUE(picture) << (picture ? "" : picture.error().message());
        if (!picture) return {};
        strands = picture->strands;
        return picture->linear;
    }
    static double coverage(const LinearImage& image) {
        double sum = 0;
        for (std::size_t i = 3; i < image.rgba.size(); i += 4) sum += static_cast<double>(image.rgba[i]);
        return sum;
    }
    std::uint64_t strands = 0;
};

/// Curls of one to 70 segments, the last of more points than a patch has.
TestStrands curls() {
    TestStrands result;
    for (const int segments : {1, 2, 7, 31, 32, 70}) {
        const auto row = static_cast<float>(result.offsets.size()) - 3.5f;
        for (int k = 0; k <= segments; ++k) {
            const float t = static_cast<float>(k) / static_cast<float>(segments);
            result.positions.emplace_back(0.3f * t - 0.15f, 0.05f * row + 0.012f * std::sin(25 * t),
                                          0.012f * std::cos(25 * t));
            result.radii.push_back(0.003f * (1 - 0.5f * t));
        }
        result.offsets.push_back(static_cast<std::uint32_t>(result.positions.size()));
    }
    return result;
}

// Where both are fine enough they are the same curve to a hundredth of a pixel; what differs are
// samples on the very edge.
TEST_F(RibbonTest, TessellatedOnesGiveTheSamePicture) {
    if (!device->info().tessellation) GTEST_SKIP() << "no tessellation on this device";
    const TestStrands strands_ = curls();
    RenderScene scene;
    scene.strands = {strands_.view()};
    scene.camera.eye_ws = {0, 0, 0.8f};
    scene.camera.target_ws = {0, 0, 0};
    scene.lights = studioLights(scene.camera);
    RenderOptions how = options(96, 4);
    how.subdivisions = 12;
    const LinearImage strip = draw(scene, how);
    how.ribbons = Ribbons::tessellated;
    const LinearImage patches = draw(scene, how);
    ASSERT_EQ(strip.rgba.size(), patches.rgba.size());
    ASSERT_GT(coverage(strip), 300);
    EXPECT_NEAR(coverage(patches), coverage(strip), 0.005 * coverage(strip));
    double sum = 0;
    std::size_t far = 0;
    for (std::size_t i = 0; i < strip.rgba.size(); ++i) {
        const float difference = std::abs(strip.rgba[i] - patches.rgba[i]);
        sum += static_cast<double>(difference);
        far += difference > 0.13f ? 1 : 0;  // more than two of 16 samples
    }
    EXPECT_LT(sum / static_cast<double>(strip.rgba.size()), 0.002);
    EXPECT_LT(far, strip.rgba.size() / 200);
}

// Kernels draw the same samples by the same chances; what differs lies on the very edge of a piece or is the
// rounding of light to 9 bits.
TEST_F(RibbonTest, KernelsGiveTheSamePicture) {
    const TestHead head(300);
    RenderScene scene = head.scene();
    for (const auto& [samples, width] : {std::pair(1u, 3.0f), std::pair(4u, 0.2f)}) {
        TestStrands strands_ = head.strands;
        for (float& radius : strands_.radii) radius *= width;
        scene.strands = {strands_.view()};
        RenderOptions how = options(64, 1);
        how.samples = samples;
        how.ribbons = Ribbons::strip;
        const LinearImage strip = draw(scene, how);
        how.ribbons = Ribbons::compute;
        const LinearImage kernels = draw(scene, how);
        ASSERT_GT(coverage(strip), 500);
        EXPECT_NEAR(coverage(kernels), coverage(strip), 0.003 * coverage(strip));
        EXPECT_NEAR(meanLuminance(kernels), meanLuminance(strip), 0.006 * meanLuminance(strip));
        std::size_t far = 0;
        for (std::size_t i = 0; i < strip.rgba.size(); ++i) {
            far += std::abs(strip.rgba[i] - kernels.rgba[i]) > 0.02f ? 1 : 0;
        }
        EXPECT_LT(far, strip.rgba.size() / 100) << samples << " samples, width " << width;
    }
}

// Close by, the head reaches behind the eye.
TEST_F(RibbonTest, KernelsDrawTrianglesThatReachBehindTheEye) {
    RenderScene scene;
    const std::vector<Vec3f> corners{{-5, -0.1f, 5}, {5, -0.1f, 5}, {0, -0.1f, -9}};
    const std::vector<std::uint32_t> indices{0, 1, 2};
    RenderMesh ground;
    ground.positions_ws = corners;
    ground.indices = indices;
    scene.meshes = {ground};
    scene.camera.eye_ws = {0, 0, 0};
    scene.camera.target_ws = {0, -0.02f, -1};
    scene.lights = studioLights(scene.camera);
    RenderOptions how = options(64, 1);
    how.samples = 4;
    how.ribbons = Ribbons::strip;
    const LinearImage strip = draw(scene, how);
    how.ribbons = Ribbons::compute;
    const LinearImage kernels = draw(scene, how);
    ASSERT_GT(coverage(strip), 1000);
    std::size_t far = 0;
    float mostSamples = 0;
    for (std::size_t i = 0; i < strip.rgba.size(); ++i) {
        const float off = std::abs(strip.rgba[i] - kernels.rgba[i]);
        far += off > 0.02f ? 1 : 0;
        if (i % 4 == 3) mostSamples = std::max(mostSamples, off * static_cast<float>(how.samples));
    }
    // At the horizon a device that rounds otherwise may take or leave one sample of a pixel.
    EXPECT_LT(mostSamples, 1.1f);
    EXPECT_LT(far, strip.rgba.size() / 100);
}

TEST_F(RibbonTest, EachKindOfTransparencyKeepsTheWidth) {
    RenderScene scene;
    scene.camera.eye_ws = {0, 0, 1};
    scene.camera.target_ws = {0, 0, 0};
    const float pixel = 2 * std::tan(radians(scene.camera.verticalFov) / 2) / 64;
    for (const Transparency kind : {Transparency::sorted, Transparency::stochastic, Transparency::weighted}) {
        for (const float width : {0.15f, 0.6f, 3.0f}) {
            TestStrands strands_;
            strands_.add({Vec3f(-1, 0.013f, 0), Vec3f(1, 0.0131f, 0)}, 0.5f * width * pixel);
            scene.strands = {strands_.view()};
            RenderOptions how = options(64, 32);
            how.transparency = kind;
            const double covered = coverage(draw(scene, how)) / 64;
            EXPECT_NEAR(covered, static_cast<double>(width), 0.05 * static_cast<double>(width))
                << static_cast<int>(kind);
        }
    }
}

// Whatever is drawn last, a hair in front weighs more than one behind it.
TEST_F(RibbonTest, BlendingDoesNotDependOnTheOrder) {
    const auto middle = [&](bool swapped) {
        TestStrands strands_;
        const float near = swapped ? -0.1f : 0.1f;
        strands_.add({Vec3f(-1, 0, near), Vec3f(1, 0, near)}, 0.003f);
        strands_.add({Vec3f(-1, 0, -near), Vec3f(1, 0, -near)}, 0.003f);
        RenderStrands both = strands_.view();
        const std::vector<Vec3f> colours = {{1, 0, 0}, {0, 1, 0}};
        both.colours = colours;
        RenderScene scene;
        scene.strands = {both};
        scene.camera.eye_ws = {0, 0, 1};
        scene.camera.target_ws = {0, 0, 0};
        RenderOptions how = options(32, 1);
        how.transparency = Transparency::weighted;
        const LinearImage image = draw(scene, how);
        return Vec3f(image.rgba[4 * (16 * 32 + 16)], image.rgba[4 * (16 * 32 + 16) + 1], 0);
    };
    const Vec3f redInFront = middle(false);
    const Vec3f greenInFront = middle(true);
    EXPECT_GT(redInFront.x(), 20 * redInFront.y());
    EXPECT_GT(greenInFront.y(), 20 * greenInFront.x());
}

TEST_F(RibbonTest, FewerHairsFarAwayCoverAsMuch) {
    TestHead head(2000);
    std::fill(head.strands.radii.begin(), head.strands.radii.end(), 0.00004f);
    RenderScene scene = head.scene();
    const Vec3f towards = (scene.camera.eye_ws - scene.camera.target_ws).normalized();
    RenderOptions how = options(64, 8);
    std::uint64_t before = 3000;
    for (const float distance : {1.0f, 2.0f, 4.0f}) {
        scene.camera.eye_ws = scene.camera.target_ws + distance * towards;
        scene.meshes.clear();
        how.detail = 0;
        const double all = coverage(draw(scene, how));
        EXPECT_EQ(strands, 2000u);
        how.detail = 0.08f;
        const double some = coverage(draw(scene, how));
        EXPECT_LT(strands, before);
        before = strands;
        EXPECT_NEAR(some, all, 0.05 * all) << distance << " m, " << strands << " hairs";
    }
    EXPECT_LT(before, 300u);
}

/// Hair without a head, seen from farther and farther away by one renderer.
class Walk {
  public:
    Walk(gpu::Device& device, std::uint32_t hairs, float radius) : device_(device), renderer_(device) {
        TestHead head(hairs);
        std::fill(head.strands.radii.begin(), head.strands.radii.end(), radius);
        RenderScene scene = head.scene();
        scene.meshes.clear();
        camera_ = scene.camera;
        towards_ = (camera_.eye_ws - camera_.target_ws).normalized();
        EXPECT_TRUE(renderer_.setScene(scene));
    }
    /// Alpha of all pixels.
    std::vector<float> at(float distance, RenderOptions how) {
        camera_.eye_ws = camera_.target_ws + distance * towards_;
        EXPECT_TRUE(renderer_.setCamera(camera_));
        how.shadows = Shadows::none;
        for (std::uint32_t i = 0; i < how.frames; ++i) {
            auto list = device_.createCommandList().value();
            EXPECT_TRUE(renderer_.record(*list, how, nullptr));
            EXPECT_TRUE(device_.submit(std::move(list)).value()->wait());
        }
        std::vector<float> sum(std::size_t{4} * how.width * how.height);
        EXPECT_TRUE(device_.readBuffer(renderer_.linearSum(), 0, std::as_writable_bytes(std::span(sum))));
        std::vector<float> alpha;
        for (std::size_t i = 3; i < sum.size(); i += 4) {
            alpha.push_back(sum[i] / static_cast<float>(how.frames));
        }
        return alpha;
    }
    std::uint64_t strands() const { return renderer_.strands(); }
    std::uint64_t pointsPerStrand() const { return renderer_.curvePoints() / renderer_.strands(); }

  private:
    gpu::Device& device_;
    Renderer renderer_;
    Camera camera_;
    Vec3f towards_;
};

struct Change {
    double mean = 0, maximum = 0;
};
Change between(const std::vector<float>& a, const std::vector<float>& b) {
    Change change;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double difference = std::abs(static_cast<double>(a[i] - b[i]));
        change.mean += difference / static_cast<double>(a.size());
        change.maximum = std::max(change.maximum, difference);
    }
    return change;
}

// From where all hairs are drawn to where few are. A step of 0.2 % in distance changes no more than where all
// are drawn, where hairs come and go and where curves become coarser.
TEST_F(RibbonTest, HairsDoNotPop) {
    Walk walk(*device, 400, 0.00015f);
    RenderOptions whole = options(48, 16);
    RenderOptions some = whole;
    some.detail = 0.3f;
    RenderOptions glance = some;
    glance.frames = 1;
    const auto pointsAt = [&](float distance) {
        walk.at(distance, glance);
        return walk.pointsPerStrand();
    };
    const std::uint64_t finest = pointsAt(0.2f);
    EXPECT_EQ(walk.strands(), 400u);
    EXPECT_LT(pointsAt(3), finest) << "curves stay as fine as they are";
    EXPECT_LT(walk.strands(), 150u);
    float fine = 0.2f, coarse = 3;
    for (int i = 0; i < 14; ++i) {
        const float middle = 0.5f * (fine + coarse);
        (pointsAt(middle) == finest ? fine : coarse) = middle;
    }
    const std::vector<float> places{fine, 1.2f, 2.0f};
    for (const float distance : places) {
        const Change all = between(walk.at(0.999f * distance, whole), walk.at(1.001f * distance, whole));
        const Change fewer = between(walk.at(0.999f * distance, some), walk.at(1.001f * distance, some));
        EXPECT_LT(fewer.maximum, all.maximum + 0.13) << distance << " m";
        EXPECT_LT(fewer.mean, 1.5 * all.mean + 0.002) << distance << " m";
    }
}

// Fewer hairs far away: over all distances they cover as much and are as bright as all hairs, and from one
// distance to the next neither jumps.
TEST_F(RibbonTest, LightAndCoverAreSteadyOverDistance) {
    TestHead head(1600);
    std::fill(head.strands.radii.begin(), head.strands.radii.end(), 0.00005f);
    RenderScene scene = head.scene();
    scene.meshes.clear();
    scene.background = Vec3f::Zero();
    const Vec3f towards = (scene.camera.eye_ws - scene.camera.target_ws).normalized();
    RenderOptions how = options(48, 16);
    how.shadows = Shadows::none;
    double coverBefore = 0, lightBefore = 0;
    std::uint64_t minimum = 1600;
    for (int step = 0; step < 6; ++step) {
        const float distance = 0.5f * std::pow(1.35f, static_cast<float>(step));
        scene.camera.eye_ws = scene.camera.target_ws + distance * towards;
        how.detail = 0;
        const LinearImage all = draw(scene, how);
        how.detail = 0.03f;
        const LinearImage some = draw(scene, how);
        minimum = std::min(minimum, strands);
        const double cover = coverage(some) / coverage(all);
        const double light = meanLuminance(some) / meanLuminance(all);
        EXPECT_NEAR(cover, 1, 0.06) << distance << " m, " << strands << " hairs";
        EXPECT_NEAR(light, 1, 0.1) << distance << " m, " << strands << " hairs";
        if (step > 0) {
            EXPECT_NEAR(cover, coverBefore, 0.05) << distance << " m";
            EXPECT_NEAR(light, lightBefore, 0.07) << distance << " m";
        }
        coverBefore = cover;
        lightBefore = light;
    }
    EXPECT_LT(minimum, 450u);
}

// In the shadow of other hairs, which are fewer and wider in its maps as well: each takes as much light as
// those it stands for.
TEST_F(RibbonTest, FewerHairsShadeAsAllDo) {
    TestHead head(6000);
    std::fill(head.strands.radii.begin(), head.strands.radii.end(), 0.00006f);
    RenderScene scene = head.scene();
    scene.background = Vec3f::Zero();
    scene.meshes[0].albedo = Vec3f::Zero();
    scene.lights = {Light{}};
    scene.environment = Environment();
    RenderOptions how = options(64, 16);
    how.shadowResolution = 512;
    for (const Shadows shadows : {Shadows::deepOpacity, Shadows::opacityMaps, Shadows::adaptive}) {
        how.shadows = shadows;
        how.detail = 0;
        const double all = meanLuminance(draw(scene, how));
        for (const float detail : {0.1f, 0.3f, 0.6f}) {
            how.detail = detail;
            const double some = meanLuminance(draw(scene, how));
            EXPECT_LT(strands, 6000u);
            EXPECT_NEAR(some / all, 1, 0.1)
                << detail << " pixels, " << strands << " hairs, shadows " << static_cast<int>(shadows);
        }
    }
}

// What hair covers falls with the square of the distance, and no pixel of thin hair stays bright.
TEST_F(RibbonTest, HairThinsWithDistanceAndDoesNotSparkle) {
    Walk walk(*device, 150, 0.00004f);
    const RenderOptions how = options(96, 16);
    double before = 0;
    float brightest = 1;
    for (const float distance : {0.5f, 1.0f, 2.0f, 4.0f}) {
        const std::vector<float> alpha = walk.at(distance, how);
        const double covered = std::accumulate(alpha.begin(), alpha.end(), 0.0) *
                               static_cast<double>(distance) * static_cast<double>(distance);
        if (before > 0) {
            EXPECT_NEAR(covered, before, 0.05 * before) << distance << " m";
        }
        before = covered;
        const float maximum = *std::max_element(alpha.begin(), alpha.end());
        EXPECT_LE(maximum, brightest) << distance << " m";
        brightest = std::min(brightest, maximum + 0.2f);
    }
}

// Highlight and rim of a round strand of a few pixels are narrower than one: a row of pixels must not show by
// chance whether its middle meets them.
TEST_F(RibbonTest, TubesShowNoDots) {
    TestStrands tube;
    tube.add({{-0.02f, 0.07f, 0}, {-0.004f, 0.02f, 0}, {0.006f, -0.03f, 0}, {0.012f, -0.07f, 0}}, 0.003f);
    RenderScene scene;
    scene.strands = {tube.view()};
    scene.strands[0].material.tubes = true;
    scene.strands[0].material.primary = Vec3f::Constant(0.3f);
    scene.strands[0].material.primaryExponent = 135;
    scene.camera.eye_ws = {0, 0, 0.45f};
    scene.camera.target_ws = Vec3f::Zero();
    scene.background = Vec3f::Zero();
    Light light;
    light.toLight_ws = Vec3f(0.5f, 0.35f, 0.8f);
    light.irradiance = Vec3f::Constant(2);
    scene.lights = {light};
    RenderOptions how = options(40, 1);
    how.samples = 4;
    how.shadows = Shadows::none;
    how.subdivisions = 4;
    const LinearImage small = draw(scene, how);
    how.width = how.height = 40 * 8;
    const LinearImage groundTruth = draw(scene, how);
    // Of some pixels, the light by what is covered.
    const auto radiance = [](const LinearImage& image, std::size_t first, std::size_t count) {
        double sum = 0, covered = 0;
        for (std::size_t i = first; i < first + count; ++i) {
            sum += static_cast<double>(image.rgba[4 * i]);
            covered += static_cast<double>(image.rgba[4 * i + 3]);
        }
        return sum / covered;
    };
    double squares = 0, worst = 0;
    for (std::size_t y = 8; y < 32; ++y) {
        const double off = radiance(small, 40 * y, 40) / radiance(groundTruth, 320 * 8 * y, 320 * 8) - 1;
        squares += off * off / 24;
        worst = std::max(worst, std::abs(off));
    }
    EXPECT_LT(worst, 0.3) << "of a row's light";
    EXPECT_LT(std::sqrt(squares), 0.15);
}

TEST_F(RibbonTest, RadiiSpreadFromStrandToStrand) {
    TestHead head(300);
    RenderScene scene = head.scene();
    scene.strands[0].radii = {};
    scene.strands[0].material.radius = 0.0003f;
    const LinearImage same = draw(scene, options(48, 8));
    scene.strands[0].material.radiusVariation = 0.9f;
    const LinearImage spread = draw(scene, options(48, 8));
    EXPECT_NE(same.rgba, spread.rgba);
    EXPECT_NEAR(coverage(spread), coverage(same), 0.05 * coverage(same));
}

}  // namespace
}  // namespace hairloom::render
