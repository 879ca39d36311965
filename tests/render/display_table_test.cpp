// SPDX-License-Identifier: GPL-3.0-or-later
// Views of colour configs as tables on devices; tests/colour has those of OpenColorIO.
#include <gmock/gmock.h>

#include "core/render/display_table.h"
#include "core/render/renderer.h"
#include "core/render/tone_map.h"
#include "core/software/device.h"
#include "tests/render/render_fixture.h"

namespace hairloom::render {
namespace {

/// A look: other primaries, a shoulder on each channel, then sRGB.
class Shoulder final : public ColourTransform {
  public:
    explicit Shoulder(float strength) : strength_(strength) {}
    void apply(std::span<float> rgba) const override {
        for (std::size_t i = 0; i < rgba.size(); i += 4) {
            const float r = rgba[i], g = rgba[i + 1], b = rgba[i + 2];
            rgba[i] = shown(0.9f * r + 0.1f * g);
            rgba[i + 1] = shown(0.05f * r + 0.9f * g + 0.05f * b);
            rgba[i + 2] = shown(0.2f * g + 0.8f * b);
        }
    }

  private:
    float shown(float light) const { return encodeSrgb(light / (light + strength_)); }
    float strength_;
};

/// What is neither continuous nor near anything that a table can hold.
class Stripes final : public ColourTransform {
  public:
    void apply(std::span<float> rgba) const override {
        for (std::size_t i = 0; i < rgba.size(); ++i) {
            if (i % 4 == 3) continue;
            const float place = std::fmod(37 * rgba[i], 1.0f);
            rgba[i] = place < 0.5f ? 0.0f : place < 0.9f ? 1.0f : std::nanf("");
        }
    }
};

std::vector<std::uint8_t> onDevice(gpu::Device& device, const RenderScene& scene,
                                   const RenderOptions& options, gpu::Format format, LinearImage* linear) {
    gpu::TextureDesc desc;
    desc.name = "shown";
    desc.width = options.width;
    desc.height = options.height;
    desc.usage = gpu::Usage::RenderTarget;
    desc.format = format;
    auto target = device.createTexture(desc);
    Renderer renderer(device);
    if (!target || !renderer.setScene(scene)) return {};
    std::vector<std::uint8_t> bytes(std::size_t{4} * options.width * options.height);
    // The first frame is with the tone curve, as before a config is chosen.
    for (const bool last : {false, true}) {
        RenderOptions now = options;
        if (!last) now.toDisplay = nullptr;
        auto list = device.createCommandList();
        if (!list || !renderer.record(**list, now, *target)) return {};
        if (!device.submit(std::move(*list))) return {};
        if (!device.readTexture(*target, std::as_writable_bytes(std::span(bytes)))) return {};
    }
    if (linear != nullptr) {
        *linear = {options.width, options.height, std::vector<float>(bytes.size())};
        EXPECT_TRUE(
            device.readBuffer(renderer.linearSum(), 0, std::as_writable_bytes(std::span(linear->rgba))));
    }
    return bytes;
}

void expectWithinACodeValue(gpu::Device& device, Ribbons ribbons) {
    const TestHead head(200);
    RenderOptions options;
    options.width = options.height = 64;
    options.frames = 1;
    options.samples = 4;
    options.ribbons = ribbons;
    options.transparency = Transparency::stochastic;
    options.toDisplay = std::make_shared<Shoulder>(0.4f);
    LinearImage linear;
    for (const gpu::Format format : {gpu::Format::Rgba8Unorm, gpu::Format::Rgba8UnormSrgb}) {
        const auto shown = onDevice(device, head.scene(), options, format, &linear);
        ASSERT_EQ(shown.size(), linear.rgba.size());
        const Image expected = showBy(*options.toDisplay, linear, options.exposure);
        int worst = 0;
        for (std::size_t i = 0; i < shown.size(); ++i)
            worst = std::max(worst, std::abs(int{shown[i]} - int{expected.rgba[i]}));
        EXPECT_LE(worst, 1);
        EXPECT_NE(expected.rgba, toneMap(linear, options.exposure).rgba);
    }
}

TEST_F(RenderTest, DeviceShowsAViewWithinACodeValue) {
    expectWithinACodeValue(*device, Ribbons::strip);
}

TEST(DisplayTable, TheSoftwareRendererShowsItToo) {
    expectWithinACodeValue(*software::makeDevice(), Ribbons::compute);
}

TEST(DisplayTable, IsAsLargeAsTheViewNeedsAndSaysWhereThatIsNotEnough) {
    const DisplayTable gentle = bakeDisplayTable(Shoulder(0.4f));
    EXPECT_LE(gentle.worst, 1);
    EXPECT_LT(gentle.side, 129u);
    EXPECT_EQ(gentle.lookUp(Vec3f::Zero()), Vec3f::Zero());
    const DisplayTable hopeless = bakeDisplayTable(Stripes());
    EXPECT_EQ(hopeless.side, 129u);
    EXPECT_GT(hopeless.worst, 1);
    EXPECT_TRUE(hopeless.lookUp({0.3f, 0.2f, 0.1f}).allFinite());
}

TEST_F(RenderTest, PicturesOfAViewAreExactAndFiltersWork) {
    const TestHead head(200);
    RenderOptions options;
    options.width = options.height = 64;
    options.frames = 1;
    options.toDisplay = std::make_shared<Shoulder>(0.4f);
    const auto picture = renderPicture(*device, head.scene(), options);
    ASSERT_TRUE(picture) << picture.error().message();
    EXPECT_EQ(picture->image.rgba, showBy(*options.toDisplay, picture->linear, options.exposure).rgba);
    RenderOptions filtered = options;
    filtered.samples = 1;
    filtered.filter = PostFilter::fxaa;
    const auto soft = renderPicture(*device, head.scene(), filtered);
    ASSERT_TRUE(soft) << soft.error().message();
    double off = 0;
    for (std::size_t i = 0; i < soft->image.rgba.size(); ++i)
        off += std::abs(int{soft->image.rgba[i]} - int{picture->image.rgba[i]});
    EXPECT_GT(off, 0);
    EXPECT_LT(off / static_cast<double>(soft->image.rgba.size()), 8);
    filtered.toDisplay = nullptr;
    const auto standard = renderPicture(*device, head.scene(), filtered);
    ASSERT_TRUE(standard);
    EXPECT_NE(standard->image.rgba, soft->image.rgba);
}

}  // namespace
}  // namespace hairloom::render
